#include "server/api/track_request.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/api/request_fixture.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

TrackSettings settings_of(json request, const Limits& limits = {}) {
  request["map"] = "town";
  return parse_track(fields_of(std::move(request), track_members()), limits).settings;
}
std::string refused_track(const json& request, const Limits& limits = {}) {
  return refused([&] { settings_of(request, limits); });
}

TEST(TrackRequest, NeedsAMapAndNothingElse) {
  const auto parsed = [](const json& request) { return parse_track(fields_of(request, track_members()), {}); };
  EXPECT_EQ(refused([&] { parsed(json::object()); }), "missing-parameter map");
  EXPECT_EQ(refused([&] { parsed({{"map", 7}}); }), "bad-parameter map");
  const auto [map, settings] = parsed({{"map", "town"}});
  EXPECT_EQ(map, "town");
  EXPECT_FALSE(settings.prior.circle || settings.prior.box || settings.prior.heading);
  EXPECT_EQ(settings.start, TrackStart::kSearch);
  EXPECT_TRUE(settings.recovers);
  EXPECT_EQ(settings.filter.max_particles, 10'000);
  EXPECT_TRUE(settings.filter.adapts_count);
  EXPECT_EQ(settings.seed, 1U);
  EXPECT_FALSE(settings.vehicle.planar);
  EXPECT_EQ(settings.vehicle.odometry_share, 0.05);
  EXPECT_TRUE(settings.vehicle.wind.is_none());
  EXPECT_EQ(settings.vehicle.scale_range, 0.0);
  EXPECT_FALSE(settings.vehicle.nadir_sigma_m);
}

TEST(TrackRequest, MayVouchForItsStartWhereThatIsANarrowCircle) {
  const json circle{{"lat", 37.76}, {"lon", 38.27}, {"radius_m", 150.0}, {"known_start", true}};
  EXPECT_TRUE(settings_of(circle).start_is_known);
  EXPECT_FALSE(settings_of({{"lat", 37.76}, {"lon", 38.27}, {"radius_m", 150.0}}).start_is_known);
  EXPECT_FALSE(settings_of({{"known_start", false}}).start_is_known);
  json wide = circle;
  wide["radius_m"] = 151.0;
  EXPECT_EQ(refused_track(wide), "parameter-out-of-range radius_m");
  EXPECT_EQ(refused_track({{"known_start", true}}), "missing-parameter radius_m");
  EXPECT_EQ(refused_track({{"bbox", {38.27, 37.76, 38.271, 37.761}}, {"known_start", true}}),
            "missing-parameter radius_m");
  EXPECT_EQ(refused_track({{"known_start", 1}}), "bad-parameter known_start");
}

TEST(TrackRequest, HasNoChoiceOfFilterOrStart) {
  EXPECT_EQ(refused_track({{"filter", "paper"}}), "unknown-field filter");
  EXPECT_EQ(refused_track({{"start", "uniform"}}), "unknown-field start");
}

TEST(TrackRequest, HasAtMostAsManyParticlesAsItAsksForAndTheLimitAllows) {
  Limits limits;
  limits.particles = 5'000;
  EXPECT_EQ(settings_of({}, limits).filter.max_particles, 5'000) << "where it does not say how many";
  EXPECT_EQ(settings_of({{"particles", 2'000}}, limits).filter.max_particles, 2'000);
  EXPECT_EQ(settings_of({{"particles", 300}}, limits).filter.min_particles, 300) << "never more than the most";
  EXPECT_EQ(refused_track({{"particles", 5'001}}, limits), "parameter-out-of-range particles");
  EXPECT_EQ(refused_track({{"particles", 99}}, limits), "parameter-out-of-range particles");
  EXPECT_EQ(refused_track({{"particles", 150.5}}, limits), "bad-parameter particles");
}

TEST(TrackRequest, TellsHowAVehicleMovesThatNoOdometryTellsOf) {
  const VehicleNoise::Planar told =
      settings_of({{"speed_m_s", -12}, {"speed_sigma_m_s", 0}, {"turn_rate_deg_s", 90}, {"turn_rate_sigma_deg_s", 18}})
          .vehicle.planar.value();
  EXPECT_EQ(told.speed_m_s.mean, -12.0);
  EXPECT_EQ(told.speed_m_s.sigma, 0.0);
  EXPECT_NEAR(told.turn_rate_rad_s.mean, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(told.turn_rate_rad_s.sigma, std::numbers::pi / 10, 1e-12);

  const VehicleNoise::Planar speed_alone = settings_of({{"speed_m_s", 20}}).vehicle.planar.value();
  EXPECT_EQ(speed_alone.speed_m_s.mean, 20.0);
  EXPECT_EQ(speed_alone.speed_m_s.sigma, 2.0);
  EXPECT_EQ(speed_alone.turn_rate_rad_s.mean, 0.0);
  EXPECT_NEAR(speed_alone.turn_rate_rad_s.sigma, Angle::degrees(5.0).radians(), 1e-12);
}

TEST(TrackRequest, IsRefusedWhereItTellsMoreOfASpeedThanTheSpeed) {
  for (const char* name : {"speed_sigma_m_s", "turn_rate_deg_s", "turn_rate_sigma_deg_s"}) {
    EXPECT_EQ(refused_track({{name, 1}}), "missing-parameter speed_m_s") << name;
  }
}

TEST(TrackRequest, IsRefusedWhereItTellsMoreThanAnyVehicleOrWindIs) {
  for (const auto& [name, most] : {std::pair("speed_m_s", 300.0),
                                   {"odometry_share", 1.0},
                                   {"wind_sigma_m_s", 100.0},
                                   {"scale_range", kMaxScaleRange}}) {
    EXPECT_NO_THROW(settings_of({{name, most}})) << name;
    EXPECT_EQ(refused_track({{name, 1.01 * most}}), std::string("parameter-out-of-range ") + name);
  }
}

TEST(TrackRequest, TellsAWindThatChangesAsItIsStrong) {
  const Wind wind = settings_of({{"wind_sigma_m_s", 5}}).vehicle.wind;
  EXPECT_EQ(wind.sigma_m_s, 5.0);
  EXPECT_DOUBLE_EQ(wind.walk(), 0.1);
}

TEST(TrackRequest, TellsWhatHoldsForAllOfTheTrack) {
  Limits limits;
  limits.search_km2 = 12.5;
  const TrackSettings settings =
      settings_of({{"seed", 7}, {"odometry_share", 0.2}, {"scale_range", 0.1}, {"nadir_sigma_m", 12}}, limits);
  EXPECT_EQ(settings.seed, 7U);
  EXPECT_EQ(settings.vehicle.odometry_share, 0.2);
  EXPECT_EQ(settings.vehicle.scale_range, 0.1);
  EXPECT_EQ(settings.vehicle.nadir_sigma_m, 12.0);
  EXPECT_EQ(settings.max_search_km2, 12.5) << "which is the operator's to say";
}

TEST(TrackRequest, TellsWhereTheVehicleMayBeAsAFixDoes) {
  const Prior prior = settings_of({{"lat", 57.7},
                                   {"lon", 11.9},
                                   {"radius_m", 300},
                                   {"bbox", {11, 57, 12, 58}},
                                   {"heading_deg", 270},
                                   {"heading_range_deg", 20}})
                          .prior;
  EXPECT_EQ(prior.circle.value().radius_m, 300.0);
  EXPECT_EQ(prior.box.value().north_east.lat_deg, 58.0);
  EXPECT_NEAR(prior.heading.value().centre.degrees(), 270.0, 1e-9);
  EXPECT_EQ(refused_track({{"lat", 57.7}, {"lon", 11.9}}), "missing-parameter radius_m");
}

StepInput step_of(json request) {
  request.update({{"sequence", 4}, {"time_us", 5'000'000}});
  return parse_step(fields_of(std::move(request), step_fields()));
}
std::string refused_step(const json& request) {
  return refused([&] { step_of(request); });
}

TEST(StepRequest, HasANumberAndATimeAndNeedsNothingElse) {
  const auto parsed = [](const json& request) { return parse_step(fields_of(request, step_fields())); };
  const StepInput step = parsed({{"sequence", 9'007'199'254'740'991}, {"time_us", 0}});
  EXPECT_EQ(step.sequence, 9'007'199'254'740'991);
  EXPECT_EQ(step.time_us, 0);
  EXPECT_FALSE(step.odometry || step.covariance || step.features);
  EXPECT_EQ(refused([&] { parsed({{"time_us", 0}}); }), "missing-parameter sequence");
  EXPECT_EQ(refused([&] { parsed({{"sequence", 0}}); }), "missing-parameter time_us");
  EXPECT_EQ(refused([&] { parsed({{"sequence", -1}, {"time_us", 0}}); }), "parameter-out-of-range sequence");
  const json not_told_apart{{"sequence", 9'007'199'254'740'993}, {"time_us", 0}};
  EXPECT_EQ(refused([&] { parsed(not_told_apart); }), "parameter-out-of-range sequence");
  EXPECT_EQ(refused([&] { parsed({{"sequence", 0}, {"time_us", 0.5}}); }), "bad-parameter time_us");
}

TEST(StepRequest, TellsOdometryWholeOrNotAtAll) {
  const json odometry{{"forward_m", 12}, {"right_m", -3}, {"turn_deg", 90}};
  EXPECT_EQ(step_of(odometry).odometry, (Odometry{12.0, -3.0, Angle::degrees(90.0)}));
  const json stood_still{{"forward_m", 0}, {"right_m", 0}, {"turn_deg", 0}};
  EXPECT_EQ(step_of(stood_still).odometry, Odometry()) << "which is not the same as saying nothing";
  for (const auto& [name, value] : odometry.items()) {
    json without = odometry;
    without.erase(name);
    EXPECT_EQ(refused_step(without), "missing-parameter " + name);
    EXPECT_EQ(refused_step({{name, value}}).substr(0, 17), "missing-parameter") << name << " alone";
    json far = odometry;
    far[name] = 100'001;
    EXPECT_EQ(refused_step(far), "parameter-out-of-range " + name);
  }
}

TEST(StepRequest, TakesATurnTheShorterWayRound) {
  const std::vector<std::pair<double, double>> told_and_taken{
      {-359.0, 1.0}, {181.0, -179.0}, {360.0, 0.0}, {-180.0, 180.0}};
  for (const auto& [told_deg, turned_deg] : told_and_taken) {
    const StepInput step = step_of({{"forward_m", 1}, {"right_m", 0}, {"turn_deg", told_deg}});
    EXPECT_NEAR(step.odometry.value().turn.degrees(), turned_deg, 1e-9) << "a heading less the one before, past north";
  }
}

TEST(StepRequest, TellsTheCovarianceOfItsOdometryRowByRow) {
  const OdometryCovariance rows{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  json request{{"forward_m", 0}, {"right_m", 0}, {"turn_deg", 0}, {"covariance", {1, 2, 3, 4, 5, 6, 7, 8, 9}}};
  EXPECT_EQ(step_of(request).covariance, rows);
  const Fields query(http::Parameters{{"sequence", "4"},
                                      {"time_us", "5"},
                                      {"forward_m", "0"},
                                      {"right_m", "0"},
                                      {"turn_deg", "0"},
                                      {"covariance", "1,2,3,4,5,6,7,8,9"}});
  EXPECT_EQ(parse_step(query).covariance, rows);
  request["covariance"] = {1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(refused_step(request), "bad-parameter covariance");
  EXPECT_EQ(refused_step({{"covariance", {1, 0, 0, 0, 1, 0, 0, 0, 1}}}), "missing-parameter forward_m");
}

}  // namespace
}  // namespace roadfix::api
