// A registry of tracks over a town, and steps for them.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "server/tracks/track_steps.hpp"
#include "tests/support/map_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::server {

/// Dead reckoning: what a track is kept for does not depend on what was seen.
inline StepInput step_of(std::int64_t sequence) {
  StepInput step;
  step.sequence = sequence;
  step.time_us = 1'000'000 * (sequence + 1);
  step.odometry = Odometry{20.0, 0.5, Angle::degrees(3.0)};
  return step;
}

inline SentStep sent(StepInput input, std::int64_t digest = 0) {
  return {std::move(input), digest, TrackTimes::Clock::now()};
}

class TrackRegistryTest : public ::testing::Test {
 protected:
  TrackRegistryTest() {
    testing::write_map_file(folder_ / "town.gpkg", town_, 2.0);
    maps_.refresh();
  }

  std::unique_ptr<TrackRegistry> registry(const TrackLimits& limits = {}, const char* file = "tracks.sqlite") const {
    return std::make_unique<TrackRegistry>(folder_ / file, limits, maps_, limits_);
  }
  static std::string begin(TrackRegistry& tracks, const std::string& client = "::1") {
    return tracks.create(client, R"({"map": "town", "particles": 500, "seed": 9})").id;
  }
  /// The answer without the name of the track.
  static std::string take(TrackRegistry& tracks, const std::string& id, std::int64_t sequence) {
    nlohmann::json answer = TrackSteps(tracks).take(id, sent(step_of(sequence), sequence), {}).answer;
    answer.erase("track");
    return answer.dump();
  }
  std::vector<std::string> undisturbed(int steps) const {
    const auto tracks = registry({}, "undisturbed.sqlite");
    const std::string id = begin(*tracks);
    std::vector<std::string> answers;
    for (int i = 0; i < steps; ++i) answers.push_back(take(*tracks, id, i));
    return answers;
  }

  const RoadGrid town_ = testing::street_map(3, {2.0, {300'100, -3'200'050}, 300, 300});
  const testing::TemporaryFolder folder_;
  const api::Limits limits_;
  MapRegistry maps_{folder_.path(), {.tiles = 1 << 20, .searches = 0}};
};

}  // namespace roadfix::server
