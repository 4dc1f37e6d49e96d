#include "core/detect/detectors.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/detect/model_files.hpp"

namespace roadfix {
namespace {

/// The two that are shipped.
class TwoNetworks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (default_model(SourceContent::kImagery) == default_model(SourceContent::kRoads)) {
      GTEST_SKIP() << "models/roadnet*.onnx are not both there";
    }
    detectors_ = std::make_unique<Detectors>(DetectorChoice());
  }

  std::string reader(SourceContent compared) const { return detectors_->compared_with(compared)->describe(); }
  std::string reads_frames_of(const std::optional<std::string>& imagery_reader) const {
    return detectors_->for_map(imagery_reader)->describe();
  }

  std::unique_ptr<Detectors> detectors_;
};

TEST_F(TwoNetworks, FramesOverRoadDataAreReadByTheNetworkForRoads) {
  EXPECT_EQ(reads_frames_of(std::nullopt), reader(SourceContent::kRoads));
}

TEST_F(TwoNetworks, FramesAreReadByTheNetworkThatReadTheMapInHoweverManyOrientations) {
  for (const SourceContent compared : {SourceContent::kImagery, SourceContent::kRoads}) {
    std::string of_map = reader(compared);
    of_map.replace(of_map.find("orientations=1"), std::string("orientations=1").size(), "orientations=8");
    EXPECT_EQ(reads_frames_of(of_map), reader(compared));
  }
}

TEST_F(TwoNetworks, FramesOverImageryThatSomebodyElseReadAreReadByTheNetworkForImagery) {
  EXPECT_EQ(reads_frames_of("tree map=probabilistic gsd_m=0.5"), reader(SourceContent::kImagery));
  EXPECT_EQ(reads_frames_of("neural roadnet-6 fnv1a64=0 gsd_m=1 orientations=1"), reader(SourceContent::kImagery));
}

TEST_F(TwoNetworks, KnowWhetherTheyReadTheMap) {
  EXPECT_TRUE(detectors_->include_reader(std::nullopt));
  EXPECT_TRUE(detectors_->include_reader(reader(SourceContent::kImagery)));
  EXPECT_TRUE(detectors_->include_reader(reader(SourceContent::kRoads)));
  EXPECT_FALSE(detectors_->include_reader("neural roadnet-6 fnv1a64=0 gsd_m=1 orientations=1"));
  EXPECT_FALSE(detectors_->include_reader("tree map=probabilistic gsd_m=0.5"));
}

TEST_F(TwoNetworks, AreMadeByThemselvesForOneMapAsTheyAreChosenOfBoth) {
  const std::optional<std::string> road_data;
  for (const auto& of_map :
       {road_data, std::optional(reader(SourceContent::kImagery)), std::optional(reader(SourceContent::kRoads)),
        std::optional<std::string>("tree map=probabilistic gsd_m=0.5")}) {
    const auto detector = detector_for_map({}, of_map);
    EXPECT_EQ(detector->describe(), reads_frames_of(of_map)) << of_map.value_or("road data");
    EXPECT_EQ(is_reader_of(*detector, of_map), detectors_->include_reader(of_map)) << of_map.value_or("road data");
  }
}

TEST_F(TwoNetworks, AreBothDescribed) {
  EXPECT_EQ(detectors_->describe(),
            reader(SourceContent::kImagery) + "; over road data " + reader(SourceContent::kRoads));
}

TEST(OneDetector, ReadsTheFramesOfAllMaps) {
  const Detectors detectors({"tree", {}, {}, {}});
  EXPECT_EQ(detectors.compared_with(SourceContent::kImagery), detectors.compared_with(SourceContent::kRoads));
  EXPECT_EQ(detectors.describe(), detectors.for_map(std::nullopt)->describe());
  EXPECT_EQ(detectors.for_map(std::nullopt)->describe(), detectors.for_map("neural roadnet-7 fnv1a64=1")->describe());
}

}  // namespace
}  // namespace roadfix
