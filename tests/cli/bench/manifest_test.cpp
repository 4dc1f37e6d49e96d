#include "cli/bench/manifest.hpp"

#include <gmock/gmock.h>

#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

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
  EXPECT_TRUE(manifest.queries[1].black_is_unobserved);
  EXPECT_EQ(manifest.queries[2].kind, QuerySet::Kind::kSimulated);
  EXPECT_EQ(manifest.queries[2].prior_radius_m, 500);
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = kManifest;
  text.replace(text.find(from), from.size(), to);
  return text;
}

void expect_complaint(const std::string& text, const std::string& part) {
  EXPECT_THAT([&] { parse_manifest(text, "."); }, ThrowsMessage<InvalidInput>(HasSubstr(part))) << text;
}

TEST(Manifest, ComplaintsNameTheField) {
  expect_complaint(with("\"count\": 5", "\"count\": -5"), "queries[0].count");
  expect_complaint(with("\"count\": 5", "\"counts\": 5"), "'counts'");
  expect_complaint(with("[400, 300]", "[400]"), "queries[0].footprint_m");
  expect_complaint(with("\"map\": \"town\", \"frames\"", "\"map\": \"city\", \"frames\""), "'city'");
  expect_complaint(with("\"as\": \"imagery\"", "\"as\": \"pixels\""), "maps[0].sources[0].as");
  expect_complaint(with("\"sift\"", "\"surf\""), "methods[1]");
  expect_complaint(std::string(kManifest).substr(0, 100), "byte");
}

}  // namespace
}  // namespace roadfix::bench
