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
    if (default_model(ComparedWith::kImagery) == default_model(ComparedWith::kRoads)) {
      GTEST_SKIP() << "models/roadnet*.onnx are not both there";
    }
    detectors_ = std::make_unique<Detectors>(DetectorChoice());
  }

  std::string reader(ComparedWith compared) const { return detectors_->compared_with(compared)->describe(); }
  std::string reads_frames_of(const std::string& imagery_reader) const {
    return detectors_->for_map(imagery_reader)->describe();
  }

  std::unique_ptr<Detectors> detectors_;
};

TEST_F(TwoNetworks, FramesOverRoadDataAreReadByTheNetworkForRoads) {
  EXPECT_EQ(reads_frames_of(""), reader(ComparedWith::kRoads));
}

TEST_F(TwoNetworks, FramesAreReadByTheNetworkThatReadTheMapInHoweverManyOrientations) {
  for (const ComparedWith compared : {ComparedWith::kImagery, ComparedWith::kRoads}) {
    std::string of_map = reader(compared);
    of_map.replace(of_map.find("orientations=1"), std::string("orientations=1").size(), "orientations=8");
    EXPECT_EQ(reads_frames_of(of_map), reader(compared));
  }
}

TEST_F(TwoNetworks, FramesOverImageryThatSomebodyElseReadAreReadByTheNetworkForImagery) {
  EXPECT_EQ(reads_frames_of("tree map=probabilistic gsd_m=0.5"), reader(ComparedWith::kImagery));
  EXPECT_EQ(reads_frames_of("neural roadnet-6 fnv1a64=0 gsd_m=1 orientations=1"), reader(ComparedWith::kImagery));
}

TEST_F(TwoNetworks, KnowWhetherTheyReadTheMap) {
  EXPECT_TRUE(detectors_->include_reader(""));
  EXPECT_TRUE(detectors_->include_reader(reader(ComparedWith::kImagery)));
  EXPECT_TRUE(detectors_->include_reader(reader(ComparedWith::kRoads)));
  EXPECT_FALSE(detectors_->include_reader("neural roadnet-6 fnv1a64=0 gsd_m=1 orientations=1"));
  EXPECT_FALSE(detectors_->include_reader("tree map=probabilistic gsd_m=0.5"));
}

TEST_F(TwoNetworks, AreMadeByThemselvesForOneMapAsTheyAreChosenOfBoth) {
  for (const std::string& of_map : {std::string(), reader(ComparedWith::kImagery), reader(ComparedWith::kRoads),
                                    std::string("tree map=probabilistic gsd_m=0.5")}) {
    const auto detector = detector_for_map({}, of_map);
    EXPECT_EQ(detector->describe(), reads_frames_of(of_map)) << of_map;
    EXPECT_EQ(is_reader_of(*detector, of_map), detectors_->include_reader(of_map)) << of_map;
  }
}

TEST_F(TwoNetworks, AreBothDescribed) {
  EXPECT_EQ(detectors_->describe(),
            reader(ComparedWith::kImagery) + "; over road data " + reader(ComparedWith::kRoads));
}

TEST(OneDetector, ReadsTheFramesOfAllMaps) {
  const Detectors detectors({"tree", {}, {}, {}});
  EXPECT_EQ(detectors.compared_with(ComparedWith::kImagery), detectors.compared_with(ComparedWith::kRoads));
  EXPECT_EQ(detectors.describe(), detectors.for_map("")->describe());
  EXPECT_EQ(detectors.for_map("")->describe(), detectors.for_map("neural roadnet-7 fnv1a64=1")->describe());
}

}  // namespace
}  // namespace roadfix
