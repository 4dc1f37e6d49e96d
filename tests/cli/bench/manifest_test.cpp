#include "cli/bench/manifest.hpp"

#include <gmock/gmock.h>

#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kManifest = R"({
  "maps": [{"name": "town", "sources": [{"path": "pre.tif", "as": "imagery"}]}],
  "queries": [
    {"map": "town", "image": "post.tif", "count": 5, "footprint_m": [400, 300], "exclude": {"bottom": 0.12}, "prior": "map"},
    {"map": "town", "frames": "frames.csv", "unobserved": "black"},
    {"map": "town", "image": null, "count": 7, "footprint_m": [200, 200], "noise": {"erase": 0.2}, "prior": {"radius_m": 500}}],
  "methods": ["roads", "sift"]})";

TEST(Manifest, ReadsAllThreeKindsOfQueries) {
  const Manifest manifest = parse_manifest(kManifest, "/data");
  ASSERT_EQ(manifest.queries.size(), 3u);
  EXPECT_EQ(manifest.maps[0].sources[0].path, "/data/pre.tif");
  EXPECT_EQ(manifest.queries[0].kind, QuerySet::Kind::kImage);
  EXPECT_EQ(manifest.queries[0].footprint.height_m, 300);
  EXPECT_EQ(manifest.queries[0].exclude.bottom, 0.12);
  EXPECT_EQ(manifest.queries[1].kind, QuerySet::Kind::kFrames);
  EXPECT_EQ(manifest.queries[1].border, Border::kBlackUnseen);
  EXPECT_EQ(manifest.queries[2].kind, QuerySet::Kind::kSimulated);
  EXPECT_EQ(manifest.queries[2].prior_radius_m, 500);
  EXPECT_FALSE(manifest.queries[2].prior_beyond_m);
}

TEST(Manifest, WithoutMethodsAsksForRoads) {
  const std::string queries = R"("queries": [{"map": "town", "frames": "frames.csv"}])";
  const std::string maps = R"("maps": [{"name": "town", "sources": [{"path": "pre.tif", "as": "imagery"}]}])";
  EXPECT_THAT(parse_manifest("{" + maps + "," + queries + "}", ".").methods, ElementsAre(MethodName::kRoads));
  EXPECT_THAT([&] { parse_manifest("{" + maps + "," + queries + R"(, "methods": []})", "."); },
              ThrowsMessage<InvalidInput>(HasSubstr("no methods")));
}

TEST(Manifest, ReadsTheQualityOfSimulatedQueriesAndWhereTheyComeFrom) {
  const Manifest manifest = parse_manifest(R"({
    "maps": [{"name": "old", "sources": [{"path": "old.pbf", "as": "roads"}]},
             {"name": "town", "sources": [{"as": "invented", "seed": 7, "side_m": 2000}]}],
    "queries": [{"map": "old", "from": "town", "elsewhere": true, "image": null, "count": 7, "footprint_m": [200, 200],
                 "noise": {"erase": [0.1, 0.5], "tilt_deg": 2}}],
    "methods": ["roads"]})",
                                           ".");
  EXPECT_EQ(manifest.maps[1].sources[0].as, ManifestSource::As::kInvented);
  EXPECT_EQ(manifest.maps[1].sources[0].seed, 7u);
  EXPECT_EQ(manifest.maps[1].sources[0].side_m, 2000.0);
  const QuerySet& set = manifest.queries.at(0);
  EXPECT_EQ(set.from, "town");
  EXPECT_TRUE(set.elsewhere);
  EXPECT_EQ(set.noise.low.erase, 0.1);
  EXPECT_EQ(set.noise.high.erase, 0.5);
  EXPECT_EQ(set.noise.low.tilt_deg, 2.0);
  EXPECT_EQ(set.noise.high.tilt_deg, 2.0);
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = kManifest;
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(Manifest, NamesTheElevationModelsOfAMap) {
  const auto terrain = [](const std::string& models) {
    return parse_manifest(with(R"("as": "imagery"}])", R"("as": "imagery"}], "terrain": )" + models), "/data")
        .maps[0]
        .terrain;
  };
  EXPECT_THAT(terrain(R"(["n37.tif", "n38.tif"])"), ElementsAre("/data/n37.tif", "/data/n38.tif"));
  EXPECT_TRUE(parse_manifest(kManifest, "/data").maps[0].terrain.empty());
  EXPECT_THAT([&] { terrain("[]"); },
              ThrowsMessage<InvalidInput>(HasSubstr("maps[0].terrain names no elevation model")));
}

TEST(Manifest, ReadsThatAPriorIsWrong) {
  const Manifest manifest = parse_manifest(with(R"({"radius_m": 500})", R"({"radius_m": 500, "beyond_m": 30})"), ".");
  EXPECT_EQ(manifest.queries[2].prior_beyond_m, 30);
}

TEST(Manifest, ReadsThatAHeadingIsToldWithACircleOrAlone) {
  const auto prior = [](const char* text) {
    return parse_manifest(with(R"({"radius_m": 500})", text), ".").queries[2];
  };
  EXPECT_EQ(prior(R"({"radius_m": 500, "heading_range_deg": 20})").prior_heading_range, Angle::degrees(20.0));
  EXPECT_EQ(prior(R"({"radius_m": 500, "heading_range_deg": 20})").prior_radius_m, 500);
  EXPECT_EQ(prior(R"({"heading_range_deg": 20})").prior_heading_range, Angle::degrees(20.0));
  EXPECT_FALSE(prior(R"({"heading_range_deg": 20})").prior_radius_m);
  EXPECT_FALSE(prior(R"({"radius_m": 500})").prior_heading_range);
  EXPECT_EQ(prior(R"({"radius_m": 500, "scale_range": 0.15})").prior_scale_range, 0.15);
  EXPECT_FALSE(prior(R"({"scale_range": 0.15})").prior_radius_m);
  EXPECT_EQ(prior(R"({"radius_m": 500})").prior_scale_range, 0.0);
}

void expect_complaint(const std::string& text, const std::string& part) {
  EXPECT_THAT([&] { parse_manifest(text, "."); }, ThrowsMessage<InvalidInput>(HasSubstr(part))) << text;
}

TEST(Manifest, ComplaintsNameTheField) {
  expect_complaint(with("\"count\": 5", "\"count\": -5"), "queries[0].count");
  expect_complaint(with("\"count\": 5", "\"count\": 2.5"), "queries[0].count must be a whole number");
  expect_complaint(with("\"count\": 5", "\"counts\": 5"), "'counts'");
  expect_complaint(with("[400, 300]", "[400]"), "queries[0].footprint_m");
  expect_complaint(with("\"map\": \"town\", \"frames\"", "\"map\": \"city\", \"frames\""), "'city'");
  expect_complaint(with("\"as\": \"imagery\"", "\"as\": \"pixels\""), "maps[0].sources[0].as");
  expect_complaint(with("\"erase\": 0.2", "\"erase\": [0.5, 0.2]"), "queries[2].noise.erase[1]");
  expect_complaint(with("\"count\": 7", "\"from\": \"city\", \"count\": 7"), "queries[2].from");
  expect_complaint(with("\"count\": 5", "\"from\": \"town\", \"count\": 5"), "queries[0].from");
  expect_complaint(with("\"prior\": \"map\"", R"("noise": {"erase": 0.2})"), "queries[0].noise needs \"image\": null");
  expect_complaint(with("\"prior\": \"map\"", R"("unobserved": "black")"), "queries[0].unobserved needs 'frames'");
  expect_complaint(with("\"unobserved\": \"black\"", "\"count\": 5"), "queries[1].count does nothing");
  expect_complaint(with("\"count\": 7", "\"elsewhere\": 1, \"count\": 7"), "queries[2].elsewhere");
  expect_complaint(with("\"count\": 7", "\"elsewhere\": true, \"count\": 7"), "queries[2].elsewhere needs \"from\"");
  expect_complaint(with("}]}],\n", R"(}]}, {"name": "town", "sources": [{"path": "b.tif", "as": "imagery"}]}],)"),
                   "maps[1].name is 'town'");
  expect_complaint(with(R"({"radius_m": 500})", R"({"heading_range_deg": 181})"), "queries[2].prior.heading_range_deg");
  expect_complaint(with(R"({"radius_m": 500})", R"({"heading_range_deg": 9, "beyond_m": 5})"), "radius_m");
  expect_complaint(with(R"({"radius_m": 500})", R"({"scale_range": 0.31})"), "queries[2].prior.scale_range");
  expect_complaint(with("\"sift\"", "\"surf\""), "methods[1]");
  expect_complaint(with("\"sift\"", "\"roads\""), "methods[1] is 'roads', as one before");
  expect_complaint(with("\"count\": 7", "\"count\": 7e999"), "number overflow");
  expect_complaint(std::string(kManifest).substr(0, 100), "byte");
}

TEST(Manifest, GivesNoNameTwice) {
  for (const auto& [once, twice] :
       {std::pair{R"("methods": ["roads"])", R"("methods": ["sift"], "methods": ["roads"])"},
        std::pair{R"("prior": "map")", R"("prior": "map", "prior": {"radius_m": 5})"}}) {
    const std::string whole = std::string(R"({"maps": [{"name": "a", "sources": [{"path": "a", "as": "roads"}]}], )") +
                              R"("queries": [{"map": "a", "frames": "f.csv", "prior": "map"}], "methods": ["roads"]})";
    EXPECT_EQ(parse_manifest(whole, ".").queries.size(), 1u);
    std::string doubled = whole;
    doubled.replace(whole.find(once), std::string(once).size(), twice);
    EXPECT_THAT([&] { parse_manifest(doubled, "."); }, ThrowsMessage<InvalidInput>(HasSubstr("' is given twice")));
  }
}

TEST(Manifest, IsAskedForSomeOfItsMethodsButForNoOther) {
  const Manifest manifest = parse_manifest(kManifest, ".");
  EXPECT_THAT(with_methods(manifest, "sift, roads").methods, ElementsAre(MethodName::kRoads, MethodName::kSift));
  EXPECT_THAT(with_methods(manifest, "sift").methods, ElementsAre(MethodName::kSift));
  for (const char* names : {"sift,surf", "orb", "roads,,sift", "roads,", ""}) {
    EXPECT_THAT([&] { with_methods(manifest, names); }, ThrowsMessage<InvalidInput>(HasSubstr("no method '"))) << names;
  }
}

}  // namespace
}  // namespace roadfix::bench
