// What the OpenAPI document says of values that are left out, and of numbers that not every integer holds.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/detect/feature_map_codec.hpp"
#include "core/detect/tree_detector.hpp"
#include "schema/schema.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/track_request.hpp"
#include "tests/support/json_schema.hpp"

namespace roadfix {
namespace {

using nlohmann::json;
using ::testing::IsEmpty;

class OpenApiDefaults : public ::testing::Test {
 protected:
  const json document_ = json::parse(schema::openapi_json());

  /// The defaults of a request's members, of those in `names`.
  json defaults(const char* schema, const std::vector<std::string>& names) const {
    json given = json::object();
    for (const auto& [name, named] : document_.at("components").at("schemas").at(schema).at("properties").items()) {
      const bool wanted = std::ranges::find(names, name) != names.end();
      const json& member = testing::resolved(document_, named);
      if (wanted && member.contains("default")) given[name] = member["default"];
    }
    return given;
  }
};

FeatureMap seen(const json& request) {
  const TreeRoadDetector detector;
  const std::vector<std::uint8_t> picture = encode_feature_map(CellArray(64, 64, 100));
  api::Content content{{}, picture, true};
  content.fields.add(request, api::feature_fields());
  return api::features_of(content, {detector, 2.0}, api::Limits{}).map;
}

// Programs that are generated from the document send defaults as if their user had told them.
TEST_F(OpenApiDefaults, OfPicturesChangeNothingWhereTheyAreSent) {
  for (const char* schema : {"FixRequest", "MatchRequest", "StepRequest"}) {
    for (const json& base : {json{{"cell_m", 2}},
                             {{"kind", "frame"}, {"gsd_m", 0.5}},
                             {{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 100}}}) {
      json all = defaults(schema, api::feature_fields());
      EXPECT_FALSE(all.empty()) << schema;
      all.update(base);
      EXPECT_EQ(seen(all), seen(base)) << schema << " " << base;
    }
  }
}

TEST_F(OpenApiDefaults, OfAFixAreTaken) {
  api::Fields fields;
  fields.add(defaults("FixRequest", api::fix_option_fields()), api::fix_option_fields());
  const FixOptions told = api::parse_fix_options(fields, {});
  const FixOptions untold = api::parse_fix_options({}, {});
  EXPECT_EQ(told.confidence, untold.confidence);
  EXPECT_EQ(told.search.max_modes, untold.search.max_modes);
  EXPECT_EQ(told.search.scale_range, untold.search.scale_range);
  EXPECT_EQ(told.search.proof_time, untold.search.proof_time);
}

TEST_F(OpenApiDefaults, OfATrackAreTaken) {
  json all = defaults("TrackRequest", api::track_members());
  EXPECT_GT(all.size(), 3U);
  all["map"] = "m";
  api::Fields fields;
  fields.add(all, api::track_members());
  const TrackSettings told = api::parse_track(fields, {}).settings;
  api::Fields map_only;
  map_only.add(json{{"map", "m"}}, api::track_members());
  const TrackSettings untold = api::parse_track(map_only, {}).settings;
  EXPECT_EQ(told.start, untold.start);
  EXPECT_EQ(told.filter.max_particles, untold.filter.max_particles);
  EXPECT_EQ(told.measurement_model.kind, untold.measurement_model.kind);
  EXPECT_EQ(told.seed, untold.seed);
  EXPECT_EQ(told.vehicle.odometry_share, untold.vehicle.odometry_share);
  EXPECT_EQ(told.vehicle.scale_range, untold.vehicle.scale_range);
}

/// Integers that may exceed 32 bits, and do not say so to those who generate programs from the document.
std::vector<std::string> large_without_format(const json& node, const std::string& where) {
  std::vector<std::string> wrong;
  if (!node.is_structured()) return wrong;
  if (node.is_object() && node.value("type", json()) == "integer" && !node.contains("format")) {
    const bool is_time = where.ends_with("_us");
    if (is_time || node.value("maximum", 0.0) > 2147483647.0) wrong.push_back(where);
  }
  for (const auto& [name, member] : node.items()) {
    for (std::string& text : large_without_format(member, where + "/" + name)) wrong.push_back(std::move(text));
  }
  return wrong;
}

TEST_F(OpenApiDefaults, IntegersBeyond32BitsSayThatTheyAre) {
  EXPECT_THAT(large_without_format(document_, ""), IsEmpty());
}

}  // namespace
}  // namespace roadfix
