#include "cli/fly/service_localizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/fly/service_answer.hpp"
#include "cli/fly/service_connection.hpp"
#include "cli/fly/service_request.hpp"
#include "server/http/client.hpp"

namespace roadfix::fly {
namespace {

using http::Answer;
using nlohmann::json;

constexpr std::chrono::seconds kFarewellTime{2};  // nobody waits for that answer

class ServiceLocalizer : public Localizer {
 public:
  ServiceLocalizer(const ServicePlan& plan, std::uint64_t seed, const Prior& start)
      : connection_(plan), base_(plan.base), keeps_(plan.keeps_tracks) {
    const std::string request = track_request(plan, seed, start).dump();
    // Should the answer be lost, the track that was begun expires without a step.
    const json track =
        connection_.ask([&](http::Client& client) { return client.post("/v1/tracks", request, "application/json"); });
    path_ = "/v1/tracks/" + track_id_of(track);
  }

  /// The track of a flight that failed or was stopped would count among its client's until it expires.
  ~ServiceLocalizer() override {
    if (keeps_ || finished_) return;
    try {
      http::Client(base_, kFarewellTime).remove(path_);
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): what ended the flight is the error to tell of
    }
  }

  TrackEstimate advance(const Report& step) override {
    const StepRequest request = step_request(step);
    return estimate_of(connection_.ask([&](http::Client& client) {
      return client.post(path_ + "/steps" + request.query, request.body, request.content_type);
    }));
  }

  std::vector<GeoPose> particles(std::size_t count) const override {
    const std::string target = fmt::format("{}?particles={}", path_, std::clamp<std::size_t>(count, 1, 10'000));
    const json track = connection_.ask([&](http::Client& client) { return client.get(target); });
    return track.contains("particles") ? particles_of(track.at("particles")) : std::vector<GeoPose>();
  }

  /// Of all that the vehicle waited for, the network and the other vehicles included.
  double clock_ms() const override { return connection_.waited().count(); }

  void finish() override {
    finished_ = true;
    if (keeps_) return;
    connection_.ask([&](http::Client& client) {
      std::optional<Answer> answer = client.remove(path_);
      constexpr int kGone = 410;
      if (answer && answer->status == kGone) answer->status = 204;  // ended already, by a request whose answer was lost
      return answer;
    });
  }

 private:
  mutable ServiceConnection connection_;
  const std::string base_;
  const bool keeps_;
  std::string path_;
  bool finished_ = false;
};

}  // namespace

LocalizerFactory service_localizers(const ServicePlan& plan) {
  return [plan](const std::string&, std::uint64_t seed, const Prior& start) -> std::unique_ptr<Localizer> {
    return std::make_unique<ServiceLocalizer>(plan, seed, start);
  };
}

std::optional<std::string> served_version(const ServicePlan& plan) {
  return version_in(ServiceConnection(plan).ask([](http::Client& client) { return client.get("/v1/maps"); }), plan.map);
}

}  // namespace roadfix::fly
