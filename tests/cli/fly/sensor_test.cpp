#include "cli/fly/sensor.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <variant>

namespace roadfix::fly {
namespace {

const GridPose kPose{{600'160.0, 6'399'850.0}, Angle::degrees(35.0)};
constexpr Footprint kFootprint{100.0, 80.0};

Orthoimage noise() {
  Orthoimage imagery{{cv::Mat(600, 600, CV_8UC3), cv::Mat(600, 600, CV_8UC1, cv::Scalar(255)), 0.5},
                     {600'000.0, 6'400'000.0}};
  cv::RNG(5).fill(imagery.image.pixels, cv::RNG::UNIFORM, 0, 256);
  imagery.image.observed.rowRange(0, 240) = 0;
  return imagery;
}

/// Remembers the picture and the seed that it was given.
class DetectorWitness : public RoadDetector {
 public:
  CellArray detect(const GroundImage& image, double, std::uint64_t seed, const std::stop_token&) const override {
    seen = image;
    told_seed = seed;
    return {1, 1, kRoad};
  }
  double preferred_gsd_m() const override { return 0.5; }
  double halo_m() const override { return 0.0; }
  std::string name() const override { return "witness"; }
  std::string settings() const override { return {}; }

  mutable GroundImage seen;
  mutable std::uint64_t told_seed = 0;
};

double difference(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() ? cv::norm(a, b, cv::NORM_INF) : std::numeric_limits<double>::infinity();
}

TEST(Camera, TakesThePictureInWhichTheVehicleItselfWouldDetectRoadsAndTheSameOneWheneverItIsAsked) {
  const Orthoimage imagery = noise();
  const DetectorWitness witness;
  evaluation::Random one(7);
  evaluation::Random other(7);
  const Observation detected = make_imaging_sensor(imagery, witness, kFootprint, {}, 2.0)->observe({kPose}, one);
  const Observation sent = make_camera(imagery, kFootprint, {}, 2.0)->observe({kPose}, other);
  EXPECT_TRUE(detected.features);
  EXPECT_FALSE(detected.frame);
  EXPECT_EQ(witness.told_seed, kDetectorSeed);
  EXPECT_FALSE(sent.features);
  EXPECT_LT(cv::countNonZero(witness.seen.observed), static_cast<int>(witness.seen.observed.total()));
  for (int i = 0; i < 2; ++i) {
    const CameraFrame frame = sent.frame();
    EXPECT_EQ(difference(frame.picture.pixels, witness.seen.pixels), 0.0);
    EXPECT_EQ(difference(frame.picture.observed, witness.seen.observed), 0.0);
    EXPECT_EQ(std::get<StraightDown>(frame.view).gsd_m, witness.seen.gsd_m);
    EXPECT_EQ(frame.cell_m, 2.0);
  }
  EXPECT_EQ(one(), other()) << "the flight goes on alike";
}

}  // namespace
}  // namespace roadfix::fly
