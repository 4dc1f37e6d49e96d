// Flights over an invented town, followed by the library, with pictures and a film.
#include "cli/fly/campaign.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <thread>
#include <vector>

#include "cli/fly/flight_pictures.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::fly {
namespace {

using testing::code_of;

class Campaigns : public ::testing::Test {
 protected:
  Campaigns() {
    plan.steps = 6;
    campaign.flights.source = [this](int, std::uint64_t seed, const std::function<void()>& seen) {
      const GridBox box{{600'420.0, 6'399'720.0}, {600'580.0, 6'399'880.0}};
      return fly(plan, box, *make_random_pilot(box, plan.handling), *sensor, seed, seen);
    };
    campaign.localizer = library_localizers(map, {200}, {});
    campaign.filters = {"default", "paper"};
    campaign.flights.number = 2;
  }

  RoadGrid town = testing::street_map(41, {2.0, {300'100, -3'200'050}, 300, 300});
  MapView map = testing::view_of(town);
  std::unique_ptr<Sensor> sensor = make_simulated_sensor(map, {300.0, 300.0}, {0.1, 0.1, 0.0, 1.0, 0.0, 0.0});
  FlightPlan plan;
  Campaign campaign;
};

TEST_F(Campaigns, GiveTheSameFlightsToAllFiltersWhateverTheNumberOfJobs) {
  const auto results = run(campaign, map.zone);
  campaign.jobs = 3;
  const auto again = run(campaign, map.zone);
  ASSERT_EQ(results.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_EQ(results[f].filter, campaign.filters[f]);
    ASSERT_EQ(results[f].runs.size(), 2u);
    for (std::size_t r = 0; r < 2; ++r) {
      ASSERT_EQ(results[f].runs[r].records.size(), 6u);
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(results[f].runs[r].records[i].truth.position, results[0].runs[r].records[i].truth.position);
        EXPECT_EQ(results[f].runs[r].records[i].error_m, again[f].runs[r].records[i].error_m);
      }
    }
  }
}

TEST_F(Campaigns, TheDefaultFilterFollowsAVehicleOverGoodFeatureMaps) {
  campaign.filters = {"default"};
  campaign.localizer = library_localizers(map, {500}, {});
  const auto results = run(campaign, map.zone);
  ASSERT_EQ(results[0].runs.size(), static_cast<std::size_t>(campaign.flights.number));
  for (const fly::Run& flight : results[0].runs) EXPECT_LT(flight.records.back().error_m, 25.0);
}

TEST_F(Campaigns, TellWhereFlightsBeginAsWellAsTheyAreAskedTo) {
  std::vector<Prior> told;
  campaign.localizer = [&](const std::string&, std::uint64_t, const Prior& start) {
    told.push_back(start);
    return make_localizer(map, TrackSettings::paper(100), {});
  };
  campaign.filters = {"default"};
  campaign.flights.number = 20;
  run(campaign, map.zone);
  for (const Prior& start : told) EXPECT_FALSE(start.circle || start.box || start.heading);
  told.clear();
  campaign.start.radius_m = 50.0;
  campaign.start.heading_half_width = Angle::degrees(15.0);
  const auto flights = run(campaign, map.zone).at(0).runs;
  double farthest_m = 0.0;
  Angle most_turned;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    const GridPose truth = flights[i].records.front().truth;
    ASSERT_TRUE(told[i].circle && told[i].heading);
    EXPECT_EQ(told[i].circle->radius_m, 50.0);
    EXPECT_EQ(told[i].heading->half_width, Angle::degrees(15.0));
    farthest_m = std::max(farthest_m, distance_m(map.zone.project(told[i].circle->centre), truth.position));
    most_turned = std::max(most_turned, angular_distance(told[i].heading->centre, on_earth(truth, map.zone).heading));
  }
  EXPECT_LE(farthest_m, 50.0 + 1e-3);
  EXPECT_LE(most_turned.degrees(), 15.0 + 1e-6);
  EXPECT_GT(farthest_m, 35.0) << "of 20; all within half the area by a chance of one in a million";
  EXPECT_GT(most_turned.degrees(), 7.5) << "likewise";
}

TEST_F(Campaigns, TellOneStepAfterAnotherHoweverManyFlyAtATime) {
  campaign.jobs = 2;
  std::vector<std::int64_t> told;
  campaign.progress = [&](std::int64_t done, std::int64_t) { told.push_back(done); };
  run(campaign, map.zone);
  std::vector<std::int64_t> counted(36);  // 2 x 6 x 3: of each flight all steps as they are flown, and by each filter
  std::iota(counted.begin(), counted.end(), 1);
  EXPECT_EQ(told, counted);
}

TEST_F(Campaigns, StopWhenTheyAreAskedTo) {
  std::stop_source stop;
  campaign.stop = stop.get_token();
  stop.request_stop();
  EXPECT_EQ(code_of([&] { run(campaign, map.zone); }), "work-stopped");
}

TEST_F(Campaigns, EndAllFlightsWhereOneFails) {
  campaign.filters = {"default"};
  campaign.jobs = 2;
  std::atomic<int> steps = 0;
  std::atomic<bool> failed = false;
  campaign.flights.source = [&](int number, std::uint64_t, const std::function<void()>& seen) -> Flight {
    if (number == 1) {
      failed = true;
      throw InvalidInput("no-place-to-fly", "for one of them");
    }
    while (!failed) std::this_thread::yield();
    while (++steps < 1'000'000) seen();
    return {};
  };
  EXPECT_EQ(code_of([&] { run(campaign, map.zone); }), "no-place-to-fly");
  EXPECT_LT(steps, 1'000'000);
}

TEST_F(Campaigns, AreShownAsPicturesAndAsAFilm) {
  const testing::TemporaryFolder folder;
  FlightPictureOptions options;
  options.folder = folder.path().string();
  options.film = "film.gif";
  options.steps = {0, 3};
  options.longest_px = 200;
  FlightPictures pictures(map, nullptr, {300.0, 300.0}, options);
  campaign.flights.number = 1;
  campaign.watch = [&](const std::string& filter, const Record& record, const Localizer& localizer) {
    pictures.show(filter, record, localizer);
  };
  run(campaign, map.zone);
  pictures.finish();
  const cv::Mat first = cv::imread((folder / "paper-0000.png").string());
  const cv::Mat last = cv::imread((folder / "default-0005.png").string());
  ASSERT_EQ(first.cols, 200);
  EXPECT_EQ(first.size(), last.size());
  EXPECT_GT(cv::norm(first, last, cv::NORM_INF), 100.0) << "the vehicle has moved";
  const std::string film = pictures.gif();
  ASSERT_GT(film.size(), 1000u);
  EXPECT_EQ(film.substr(0, 6), "GIF89a");
  EXPECT_EQ(static_cast<unsigned char>(film[6]) + 256 * static_cast<unsigned char>(film[7]), 400) << "side by side";
  EXPECT_EQ(film.back(), ';');
}

TEST(FilterNames, RunFromThePapersFilterToTheDefaultAndOthersAreRefused) {
  EXPECT_EQ(filter_named("paper", 700).measurement_model.kind, LikelihoodKind::kEquation7);
  EXPECT_EQ(filter_named("likelihood", 700).start, TrackStart::kUniform);
  EXPECT_EQ(filter_named("likelihood", 700).filter.injection, Injection::kFixedShare);
  EXPECT_EQ(filter_named("injection", 700).filter.injection, Injection::kLikelihoodAverages);
  EXPECT_EQ(filter_named("search", 700).filter.adapts_count, false);
  EXPECT_EQ(filter_named("default", 700).filter.max_particles, 700);
  EXPECT_EQ(filter_named("default", 700).measurement_model.kind, LikelihoodKind::kCorrelation);
  EXPECT_EQ(filter_named("default", 700).filter.adapts_count, true);
  EXPECT_EQ(code_of([] { filter_named("papr", 700); }), "filter-unknown");
}

}  // namespace
}  // namespace roadfix::fly
