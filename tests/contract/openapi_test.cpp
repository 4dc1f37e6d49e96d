// The OpenAPI document and the routes say the same, in both directions.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/detect/detectors.hpp"
#include "core/detect/feature_map_codec.hpp"
#include "core/units/error.hpp"
#include "schema/schema.hpp"
#include "server/api/altitude_request.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/flight_request.hpp"
#include "server/api/position_answer.hpp"
#include "server/api/track_request.hpp"
#include "server/service.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using nlohmann::json;
using ::testing::EndsWith;
using ::testing::IsEmpty;

class OpenApi : public ::testing::Test {
 protected:
  const json document_ = json::parse(schema::openapi_json());
  const testing::TemporaryFolder folder_{};
  server::MapRegistry maps_{folder_.path(), {.tiles = 1 << 20, .searches = 0}};
  const Detectors detectors_{{"tree", {}, {}, {}}};
  const api::Limits limits_{};
  const http::ServerSettings http_{};
  http::Metrics metrics_;
  server::PictureCache pictures_{1 << 20};
  server::TrackRegistry tracks_{folder_ / "tracks.sqlite", {}, maps_, limits_};
  server::TrackSteps steps_{tracks_};
  server::SearchThreads search_threads_{1};
  const server::Service service_{.maps = maps_,
                                 .detectors = detectors_,
                                 .limits = limits_,
                                 .http = http_,
                                 .metrics = metrics_,
                                 .pictures = pictures_,
                                 .tracks = tracks_,
                                 .steps = steps_,
                                 .search_threads = search_threads_};
  const http::Router router_ = server::make_router(service_);

  const json& resolved(const json& node) const { return testing::resolved(document_, node); }

  /// Names of an operation's parameters that are in `place`, those of its path included.
  std::set<std::string> parameters(const json& path, const json& operation, const std::string& place) const {
    std::set<std::string> names;
    for (const json* holder : {&path, &operation}) {
      for (const json& parameter : holder->value("parameters", json::array())) {
        const json& it = resolved(parameter);
        if (it.at("in") == place) names.insert(it.at("name").get<std::string>());
      }
    }
    return names;
  }

  int check_examples(const json& holder, const std::string& where) const {
    int examples = 0;
    const json contents = holder.value("content", json::object());
    for (const auto& [type, content] : contents.items()) {
      if (!content.contains("example")) continue;
      ++examples;
      EXPECT_THAT(testing::breaches(document_, content.at("schema"), content["example"]), IsEmpty()) << where;
    }
    return examples;
  }
};

std::string method_of(std::string name) {
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

TEST_F(OpenApi, DocumentsEveryRouteAndNoOther) {
  std::set<std::string> documented;
  for (const auto& [path, item] : document_.at("paths").items()) {
    for (const auto& [method, operation] : item.items()) {
      if (method != "parameters") documented.insert(method_of(method) + " " + path);
    }
  }
  std::set<std::string> registered;
  for (const http::Route& route : router_.routes()) registered.insert(route.method + " " + route.path);
  EXPECT_EQ(documented, registered);
}

TEST_F(OpenApi, NamesOperationsByWhatTheyDo) {
  // Generated clients make functions of these.
  static const std::regex kVerbAndNoun("(get|list|match|find|begin|end|take|detect)([A-Z][a-z]+)+");
  std::set<std::string> names;
  for (const auto& [path, item] : document_.at("paths").items()) {
    for (const auto& [method, operation] : item.items()) {
      if (method == "parameters") continue;
      const std::string name = operation.at("operationId");
      EXPECT_TRUE(std::regex_match(name, kVerbAndNoun)) << name;
      EXPECT_TRUE(names.insert(name).second) << name << " names two operations";
    }
  }
}

TEST_F(OpenApi, DocumentsEveryParameterAndNoOther) {
  for (const http::Route& route : router_.routes()) {
    std::string method = route.method;
    for (char& c : method) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const json& path = document_.at("paths").at(route.path);
    const json& operation = path.at(method);
    EXPECT_EQ(parameters(path, operation, "query"),
              std::set<std::string>(route.parameters.begin(), route.parameters.end()))
        << route.path;
    std::set<std::string> in_path;
    for (std::size_t open = route.path.find('{'); open != std::string::npos; open = route.path.find('{', open + 1)) {
      in_path.insert(route.path.substr(open + 1, route.path.find('}', open) - open - 1));
    }
    EXPECT_EQ(parameters(path, operation, "path"), in_path) << route.path;
  }
}

TEST_F(OpenApi, DocumentsEveryMemberOfAJsonBodyAndNoOther) {
  const auto members = [&](const char* schema) {
    std::set<std::string> names;
    for (const auto& [name, ignored] : document_.at("components").at("schemas").at(schema).at("properties").items())
      names.insert(name);
    return names;
  };
  std::set<std::string> fix(api::feature_fields().begin(), api::feature_fields().end());
  fix.insert(api::flight_members().begin(), api::flight_members().end());
  std::set<std::string> match = fix;
  fix.insert(api::altitude_fields().begin(), api::altitude_fields().end());
  fix.insert(api::prior_fields().begin(), api::prior_fields().end());
  fix.insert(api::fix_option_fields().begin(), api::fix_option_fields().end());
  fix.insert(api::position_fields().begin(), api::position_fields().end());
  fix.insert("time_us");
  match.insert({"heading_step_deg", "poses"});
  std::set<std::string> detect(api::frame_fields().begin(), api::frame_fields().end());
  detect.insert({"image", "compare_with", "format"});
  EXPECT_EQ(members("FixRequest"), fix);
  EXPECT_EQ(members("MatchRequest"), match);
  EXPECT_EQ(members("DetectRequest"), detect);
  EXPECT_EQ(members("TrackRequest"), std::set<std::string>(api::track_members().begin(), api::track_members().end()));
  std::set<std::string> step(api::feature_fields().begin(), api::feature_fields().end());
  step.insert(api::altitude_fields().begin(), api::altitude_fields().end());
  step.insert(api::picture_members().begin(), api::picture_members().end());
  step.insert(api::step_fields().begin(), api::step_fields().end());
  step.insert(api::position_fields().begin(), api::position_fields().end());
  EXPECT_EQ(members("StepRequest"), step);
}

/// Gives every number of a request in turn its bounds and what lies just beyond, beside the members of `base`.
void expect_ranges(const json& document, const char* request, const json& base,
                   const std::function<void(const json&)>& parse) {
  const auto taken = [&](json body, const std::string& name, const json& value) {
    body[name] = value;
    try {
      parse(body);
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  const json& schema = document.at("components").at("schemas").at(request);
  for (const auto& property : schema.at("properties").items()) {
    const std::string& name = property.key();
    const json& member = testing::resolved(document, property.value());
    const std::string type = member.value("type", "");
    if (!base.contains(name) || (type != "number" && type != "integer")) continue;
    const auto beyond = [&](const char* bound, int sign) -> json {
      const double least = type == "integer" ? 1.0 : 1e-3;
      const double value = member.at(bound).get<double>();
      const double outside = value + sign * std::max(least, 1e-9 * std::abs(value));
      return type == "integer" ? json(static_cast<std::int64_t>(outside)) : json(outside);
    };
    for (const auto& [bound, sign] : {std::pair{"minimum", -1}, {"maximum", 1}}) {
      if (!member.contains(bound)) continue;
      EXPECT_TRUE(taken(base, name, member[bound])) << name << " is not taken at its " << bound;
      EXPECT_FALSE(taken(base, name, beyond(bound, sign))) << name << " is taken beyond its " << bound;
    }
    EXPECT_TRUE(member.contains("minimum") || member.contains("exclusiveMinimum")) << name;
    EXPECT_TRUE(member.contains("maximum") || name == "particles") << name << ": its limit is the operator's";
    if (member.contains("exclusiveMinimum")) {
      EXPECT_FALSE(taken(base, name, member["exclusiveMinimum"])) << name << " is taken at its exclusive minimum";
    }
  }
}

TEST_F(OpenApi, StatesTheRangesOfNumbersThatAreTaken) {
  const json prior{{"lat", 1},          {"lon", 2}, {"radius_m", 300}, {"heading_deg", 4}, {"heading_range_deg", 5},
                   {"scale_range", 0.1}};
  json fix{{"confidence", 0.9}, {"max_modes", 1},     {"proof_s", 0},
           {"time_limit_s", 1}, {"nadir_sigma_m", 3}, {"nadir_heading_sigma_deg", 1}};
  fix.update(prior);
  expect_ranges(document_, "FixRequest", fix, [&](const json& body) {
    api::Fields fields;
    fields.add(
        body,
        api::joined({api::prior_fields(), api::fix_option_fields(), {"nadir_sigma_m", "nadir_heading_sigma_deg"}}));
    api::parse_prior(fields);
    api::parse_fix_options(fields, limits_);
    api::parse_time_limit(fields);
    api::told_nadir_sigma_m(fields);
    api::told_nadir_heading_sigma(fields);
  });
  json track{{"map", "m"},
             {"particles", 1000},
             {"nadir_sigma_m", 3},
             {"seed", 1},
             {"speed_m_s", 3},
             {"speed_sigma_m_s", 1},
             {"turn_rate_deg_s", 0},
             {"turn_rate_sigma_deg_s", 1},
             {"odometry_share", 0.1},
             {"wind_sigma_m_s", 1}};
  track.update(prior);
  expect_ranges(document_, "TrackRequest", track, [&](const json& body) {
    api::Fields fields;
    fields.add(body, api::track_members());
    api::parse_track(fields, limits_);
  });
  const json step{{"sequence", 1},
                  {"time_us", 1},
                  {"forward_m", 0},
                  {"right_m", 0},
                  {"turn_deg", 0},
                  {"nadir_sigma_m", 0},
                  {"nadir_heading_sigma_deg", 0}};
  expect_ranges(document_, "StepRequest", step, [&](const json& body) {
    api::Fields fields;
    fields.add(body, api::joined({api::step_fields(), {"nadir_sigma_m", "nadir_heading_sigma_deg"}}));
    api::parse_step(fields);
    api::told_nadir_sigma_m(fields);
    api::told_nadir_heading_sigma(fields);
  });
  const std::vector<std::uint8_t> frame = encode_feature_map(CellArray(32, 32, 100));
  expect_ranges(document_, "DetectRequest", {{"cell_m", 2}}, [&](const json& body) {
    api::Content content{{}, frame, true};
    content.fields.add(body, api::frame_fields());
    content.fields.add_text("gsd_m", "0.5");
    api::detected(content, {*detectors_.for_map(std::nullopt), 2.0}, limits_);
  });
}

TEST_F(OpenApi, SaysTheSameOfAParameterAndOfTheMemberOfThatName) {
  int both = 0;
  for (const auto& [path, item] : document_.at("paths").items()) {
    for (const auto& [method, operation] : item.items()) {
      if (!operation.is_object() || !operation.contains("requestBody")) continue;
      const json& body = resolved(operation["requestBody"]["content"]["application/json"]["schema"]);
      for (const json& named : operation.value("parameters", json::array())) {
        const json& parameter = resolved(named);
        const std::string name = parameter.at("name");
        if (!body.at("properties").contains(name)) continue;
        const json& member = body["properties"][name];
        EXPECT_EQ(parameter.at("schema"), member) << method << " " << path << ": " << name;
        // Twice, since some programs show only the text of a parameter, others only that of its schema.
        const json& schema = resolved(member);
        if (schema.contains("description")) {
          EXPECT_EQ(parameter.at("description"), schema["description"]) << name;
        }
        ++both;
      }
    }
  }
  EXPECT_GT(both, 60);
}

TEST_F(OpenApi, NamesEveryFormatOfAPositionAndNoOther) {
  const auto asked_for = [](const std::string& name) {
    api::Fields fields;
    fields.add({{"format", name}}, api::position_fields());
    return api::parse_position_format({}, fields);
  };
  std::string names;
  for (const std::string name : document_.at("components").at("schemas").at("PositionFormat").at("enum")) {
    names += (names.empty() ? "" : ", ") + name;
    const std::string type(asked_for(name).type);
    for (const char* path : {"/v1/maps/{map}/fix", "/v1/tracks/{id}/steps"}) {
      EXPECT_TRUE(document_.at("paths").at(path).at("post").at("responses").at("200").at("content").contains(type))
          << path << " answers " << type;
    }
  }
  EXPECT_THAT(testing::message_of([&] { asked_for("best"); }), EndsWith("one of: " + names));
}

TEST_F(OpenApi, GivesExamplesThatAreAsItDescribesThem) {
  int examples = 0;
  for (const auto& [path, item] : document_.at("paths").items()) {
    for (const auto& [method, operation] : item.items()) {
      if (method == "parameters") continue;
      if (operation.contains("requestBody")) examples += check_examples(operation["requestBody"], path + " body");
      for (const auto& [status, response] : operation.at("responses").items()) {
        examples += check_examples(resolved(response), path + " " + status);
      }
    }
  }
  EXPECT_GT(examples, 20);
}

TEST_F(OpenApi, RefersOnlyToWhatIsThere) {
  const std::string text = document_.dump();
  int references = 0;
  for (std::size_t at = text.find("\"$ref\":\"#"); at != std::string::npos; at = text.find("\"$ref\":\"#", at + 1)) {
    const std::size_t begin = at + 9;
    const std::string pointer = text.substr(begin, text.find('"', begin) - begin);
    EXPECT_TRUE(document_.contains(json::json_pointer(pointer))) << pointer;
    ++references;
  }
  EXPECT_GT(references, 10);
}

}  // namespace
}  // namespace roadfix
