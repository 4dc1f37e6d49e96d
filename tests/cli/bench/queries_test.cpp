#include "cli/bench/queries.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "core/detect/tree_detector.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

double from_the_centre_of_the_prior_m(const Query& query, const UtmZone& zone) {
  return distance_m(zone.project(query.prior.circle.value().centre), zone.project(query.truth.value().position));
}

/// Queries of a small town, which a test gives a prior.
class Queries : public ::testing::Test {
 protected:
  Queries() {
    set_.kind = QuerySet::Kind::kSimulated;
    set_.count = 20;
    set_.footprint = {200.0, 200.0};
  }

  std::vector<Query> drawn_on(const MapView& searched) const {
    std::vector<Query> queries = make_queries(set_, searched, map_, detector_, {}).queries;
    EXPECT_FALSE(queries.empty()) << "tests look at each";
    return queries;
  }
  std::vector<Query> drawn() const { return drawn_on(map_); }

  const MapView map_ = testing::view_of(testing::street_map(5, {2.0, {300'000, -3'200'000}, 500, 400}));
  const TreeRoadDetector detector_;
  QuerySet set_;
};

TEST_F(Queries, TellACircleThatHoldsTheTruthOrOneThatItLiesSoFarBeyond) {
  set_.prior_radius_m = 100.0;
  for (const Query& query : drawn()) {
    EXPECT_LE(from_the_centre_of_the_prior_m(query, map_.zone), 100.0);
  }
  set_.prior_beyond_m = 30.0;
  for (const Query& query : drawn()) {
    EXPECT_NEAR(from_the_centre_of_the_prior_m(query, map_.zone), 130.0, 0.01);
    EXPECT_EQ(query.prior.circle->radius_m, 100.0);
  }
}

TEST_F(Queries, TellAHeadingWithinARangeOfTheTrueOne) {
  set_.prior_heading_range = Angle::degrees(20.0);
  double farthest_deg = 0.0;
  for (const Query& query : drawn()) {
    EXPECT_FALSE(query.prior.circle);
    EXPECT_EQ(query.prior.heading.value().half_width, Angle::degrees(20.0));
    farthest_deg =
        std::max(farthest_deg, angular_distance(query.prior.heading->centre, query.truth.value().heading).degrees());
  }
  EXPECT_LE(farthest_deg, 20.0);
  EXPECT_GT(farthest_deg, 10.0) << "it is not the true one";
}

TEST_F(Queries, AskForTheSizesOfTheGroundThatTheirSetNames) {
  for (const double range : {0.0, 0.15}) {
    set_.prior_scale_range = range;
    for (const Query& query : drawn()) EXPECT_EQ(query.scale_range, range);
  }
}

TEST_F(Queries, TellOnlyCirclesThatMeetTheMap) {
  set_.prior_radius_m = 100.0;
  set_.prior_beyond_m = 400.0;
  for (const Query& query : drawn()) {
    EXPECT_NO_THROW(region_of(map_, query.prior)) << query.id;
    EXPECT_NEAR(from_the_centre_of_the_prior_m(query, map_.zone), 500.0, 0.01);
  }
  set_.prior_beyond_m = 2000.0;
  EXPECT_THROW(drawn(), InvalidInput);
}

TEST_F(Queries, ShowACellWhereTheirFootprintIsSmaller) {
  set_.footprint = {0.4 * map_.cell_m, 3.0 * map_.cell_m};
  for (const Query& query : drawn_on(map_)) {
    EXPECT_EQ(query.features.value().cells.cols(), 1);
    EXPECT_EQ(query.features.value().cells.rows(), 3);
  }
}

TEST_F(Queries, ShowOfAnotherMapOnlyGroundThatLiesOnTheSearchedOne) {
  const MapView west = testing::view_of(testing::street_map(5, {2.0, {300'000, -3'200'000}, 250, 400}));
  set_.from = "newer";
  for (const Query& query : drawn_on(west)) {
    EXPECT_TRUE(west.extent.contains(map_.zone.project(query.truth.value().position))) << query.id;
  }
}

/// Of frames whose places a test gives: 0.png, 1.png ...
class QueriesOfFrames : public Queries {
 protected:
  QueriesOfFrames() {
    set_.kind = QuerySet::Kind::kFrames;
    set_.path = folder_ / "frames.csv";
  }

  void frames_at(std::initializer_list<LatLon> places) const {
    std::ofstream csv(set_.path);
    csv << "file,lat,lon,heading_deg,gsd_m\n";
    for (int i = 0; const LatLon at : places) {
      const std::string name = std::to_string(i++) + ".png";
      cv::imwrite(folder_ / name, cv::Mat(20, 20, CV_8UC1, cv::Scalar(90)));
      csv << name << ',' << at.lat_deg << ',' << at.lon_deg << ",0,1\n";
    }
  }

  const testing::TemporaryFolder folder_;
  const LatLon on_map_ = map_.zone.unproject(map_.extent.centre());
  const LatLon beyond_{on_map_.lat_deg + 0.5, on_map_.lon_deg};
  const LatLon far_away_{on_map_.lon_deg, on_map_.lat_deg};
};

TEST_F(QueriesOfFrames, AreRefusedWhereNoneLiesOnTheMap) {
  frames_at({beyond_, far_away_});
  EXPECT_EQ(testing::code_of([&] { drawn(); }), "frames-outside-map");
  frames_at({beyond_, on_map_});
  EXPECT_EQ(drawn().size(), 2U);
  frames_at({beyond_});
  set_.elsewhere = true;
  EXPECT_EQ(drawn().size(), 1U);
}

TEST_F(QueriesOfFrames, NameTheOneThatIsFarAway) {
  frames_at({on_map_, far_away_});
  EXPECT_THAT([&] { drawn(); }, ThrowsMessage<InvalidInput>(HasSubstr("frames.csv: 1.png at latitude")));
}

TEST_F(QueriesOfFrames, AreNotAskedWhereNoCircleAroundThemMeetsTheMap) {
  set_.prior_radius_m = 500.0;
  frames_at({beyond_, on_map_});
  const std::vector<Query> queries = drawn();
  ASSERT_EQ(queries.size(), 2U);
  EXPECT_EQ(queries[0].unasked, "prior-outside-map");
  EXPECT_EQ(queries[1].unasked, "");
  set_.prior_beyond_m = 5000.0;
  EXPECT_THAT([&] { drawn(); }, ThrowsMessage<InvalidInput>(HasSubstr("wrong by 5000 m: no such circle meets the map")))
      << "nor does any around those on the map";
}

TEST_F(Queries, CombineTheFramesOfAFlightAlsoWhereFlightsTakeTurnsInTheFile) {
  const testing::TemporaryFolder folder;
  cv::imwrite(folder / "a.png", cv::Mat(20, 20, CV_8UC1, cv::Scalar(90)));
  std::ofstream(folder / "frames.csv") << "file,sequence,lat,lon,heading_deg,gsd_m\n"
                                          "a.png,1,36,21,0,1\na.png,2,37,21,0,1\n"
                                          "a.png,1,36,21,0,1\na.png,2,37,21,0,1\na.png,1,36,21,0,1\n";
  set_.elsewhere = true;  // than on the map
  set_.kind = QuerySet::Kind::kFrames;
  set_.path = folder / "frames.csv";
  set_.together = 2;
  std::vector<std::size_t> earlier;
  const std::vector<Query> queries = drawn();
  for (std::size_t i = 0; i < queries.size(); ++i) {
    earlier.push_back(queries[i].earlier.size());
    for (const EarlierFrame& frame : queries[i].earlier) {
      EXPECT_NEAR(frame.offset.forward_m, 0.0, 0.01);
      EXPECT_EQ(frame.view, queries[i - 2].view) << "kept once";
    }
  }
  EXPECT_EQ(earlier, (std::vector<std::size_t>{0, 0, 1, 1, 1}));
}

}  // namespace
}  // namespace roadfix::bench
