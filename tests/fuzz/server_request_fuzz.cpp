// Requests to the service: the target of the request line, and bodies of POST .../fix and .../match.
// The first byte chooses: 't' target, 'j' JSON, 'm' form with the boundary "b", 'p' PNG, 'a' Accept, 'z' gzip.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/units/error.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/flight_request.hpp"
#include "server/api/media.hpp"
#include "server/api/window.hpp"
#include "server/http/gunzip.hpp"
#include "server/http/url.hpp"

namespace {

namespace api = roadfix::api;
namespace http = roadfix::http;

/// Stands for a detector that costs nothing: what is fuzzed lies before it.
class NoRoads : public roadfix::RoadDetector {
 public:
  roadfix::CellArray detect(const roadfix::GroundImage& image, double cell_m, std::uint64_t,
                            const std::stop_token&) const override {
    const double cells = image.gsd_m / cell_m;
    return {static_cast<int>(image.pixels.cols * cells) + 1, static_cast<int>(image.pixels.rows * cells) + 1,
            roadfix::kNoRoad};
  }
  double preferred_gsd_m() const override { return 1.0; }
  double halo_m() const override { return 0.0; }
  std::string name() const override { return "none"; }
  std::string settings() const override { return {}; }
};

const std::vector<std::string>& members() {
  static const std::vector<std::string> kMembers = [] {
    std::vector<std::string> all = api::feature_fields();
    for (const auto* more : {&api::prior_fields(), &api::fix_option_fields(), &api::flight_members()})
      all.insert(all.end(), more->begin(), more->end());
    all.emplace_back("poses");
    return all;
  }();
  return kMembers;
}

api::Limits small_limits() {
  api::Limits limits;
  limits.pixels = 10'000;
  limits.cells = 10'000;
  limits.poses = 100;
  return limits;
}

void read_target(std::string_view text) {
  const http::Target target = http::parse_target(text);
  const api::Fields fields(target.query);
  api::parse_window(fields);
}

void read_body(const std::string& type, std::string_view body, const http::Parameters& query) {
  http::Request request;
  request.headers["content-type"] = type;
  request.body = body;
  request.query = query;
  const api::Limits limits = small_limits();
  const api::Content content = api::read_content(request, members(), limits);
  api::parse_prior(content.fields);
  if (content.fields.has("poses")) api::parse_poses(content.fields, limits);
  api::features_of(content, {NoRoads(), 2.0}, limits);
}

void read_packed(std::string_view stream) {
  constexpr std::size_t kMost = 100'000;
  http::Gunzip gunzip;
  std::size_t unpacked = 0;
  gunzip.unpack(stream, [&](const char*, std::size_t size) { return (unpacked += size) < kMost; });
}

void read_request(char kind, std::string_view text) {
  constexpr std::array<api::Media, 2> kOffered{{{"png", "image/png"}, {"json", "application/json"}}};
  switch (kind) {
    case 't':
      return read_target(text);
    case 'j':
      return read_body("application/json", text, {});
    case 'm':
      return read_body("multipart/form-data; boundary=b", text, {});
    case 'p':
      return read_body("image/png", text, {{"cell_m", "2"}});
    case 'a':
      api::negotiated(text, kOffered);
      return;
    case 'z':
      return read_packed(text);
    default:
      return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  try {
    read_request(static_cast<char>(data[0]), {reinterpret_cast<const char*>(data) + 1, size - 1});
  } catch (const roadfix::Error&) {  // NOLINT(bugprone-empty-catch): refusing is right, anything else is a bug
  }
  return 0;
}
