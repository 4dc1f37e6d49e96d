#include "core/detect/make_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <string>

#include "core/detect/model_files.hpp"
#include "core/units/error.hpp"
#include "tests/support/as_another_user.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;

/// A folder with tiny.onnx and its description, and no ROADFIX_MODEL in the environment.
class MakeDetector : public ::testing::Test {
 protected:
  void SetUp() override {
    unsetenv("ROADFIX_MODEL");
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("roadfix_make_" + std::string(info->name()));
    fs::create_directories(folder_);
    fs::copy_file(fs::path(ROADFIX_TEST_NETWORKS) / "tiny.onnx", model(), fs::copy_options::overwrite_existing);
    std::ofstream(folder_ / "tiny.json")
        << R"({ "name": "tiny", "gsd_m": 1.0, "stride": 2, "multiple": 16, "tile_px": 512, "overlap_px": 32,
                "channels": "rgb", "mean": [100, 110, 120], "std": [50, 60, 70], "output": "logits",
                "calibration": { "scale": 1.0, "bias": 0.0 } })";
  }
  void TearDown() override {
    unsetenv("ROADFIX_MODEL");
    fs::remove_all(folder_);
  }

  fs::path model() const { return folder_ / "tiny.onnx"; }

  static std::string refusal(const DetectorChoice& choice) {
    try {
      make_detector(choice, SourceContent::kImagery);
    } catch (const InvalidInput& error) {
      return error.code();
    }
    return "accepted";
  }

  fs::path folder_;
};

TEST_F(MakeDetector, TakesTheNamedModelAndItsOrientations) {
  const std::string description = make_detector({"neural", model(), 4, {}}, SourceContent::kImagery)->describe();
  EXPECT_NE(description.find("neural tiny"), std::string::npos);
  EXPECT_NE(description.find("orientations=4"), std::string::npos);
}

TEST_F(MakeDetector, AutoIsNeuralWhereAModelIsNamed) {
  EXPECT_NE(make_detector({"auto", model(), 1, {}}, SourceContent::kRoads)->describe().find("neural tiny"),
            std::string::npos);
}

TEST_F(MakeDetector, TheEnvironmentNamesTheDefaultModelOfBoth) {
  setenv("ROADFIX_MODEL", model().c_str(), 1);
  for (const SourceContent compared : {SourceContent::kImagery, SourceContent::kRoads}) {
    EXPECT_EQ(default_model(compared), model());
    EXPECT_NE(make_detector({}, compared)->describe().find("neural tiny"), std::string::npos);
  }
}

TEST_F(MakeDetector, AWrongEnvironmentIsSaidAndNotPassedOver) {
  setenv("ROADFIX_MODEL", "/nowhere/roadnet.onnx", 1);
  EXPECT_EQ(refusal({}), "model-missing");
}

TEST_F(MakeDetector, TheFirstModelThatIsThereIsTaken) {
  EXPECT_EQ(first_model({folder_ / "none.onnx", model() / "beside.onnx", model()}), model());
  EXPECT_EQ(first_model({folder_ / "none.onnx", folder_}), std::nullopt);
}

TEST_F(MakeDetector, AShippedNetworkInPlaceOfTheOtherOneIsTold) {
  EXPECT_EQ(stood_in_for(folder_ / "roadnet.onnx", SourceContent::kImagery), "roadnet-imagery.onnx");
  EXPECT_EQ(stood_in_for(folder_ / "roadnet-imagery.onnx", SourceContent::kRoads), "roadnet.onnx");
  EXPECT_EQ(stood_in_for(folder_ / "roadnet.onnx", SourceContent::kRoads), std::nullopt);
  EXPECT_EQ(stood_in_for(folder_ / "roadnet-imagery.onnx", SourceContent::kImagery), std::nullopt);
  EXPECT_EQ(stood_in_for(model(), SourceContent::kRoads), std::nullopt) << "somebody's own";
}

TEST_F(MakeDetector, AModelThatMayNotBeReadIsNotPassedOver) {
  fs::permissions(folder_, fs::perms{0700});
  const testing::AsAnotherUser reader;
  if (reader.may_do_everything()) GTEST_SKIP();
  try {
    first_model({folder_ / "tiny.onnx"});
    ADD_FAILURE() << "it was not to be seen";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.code(), "model-missing");
    EXPECT_NE(std::string(error.what()).find("Permission denied"), std::string::npos) << error.what();
  }
}

TEST_F(MakeDetector, TheTreeNeedsNoModelAndRefusesOne) {
  EXPECT_EQ(make_detector({"tree", {}, {}, {}}, SourceContent::kImagery)->describe().substr(0, 5), "tree ");
  EXPECT_EQ(refusal({"tree", model(), {}, {}}), "model-without-network");
}

TEST_F(MakeDetector, WhatIsSaidOfTheOtherDetectorIsRefused) {
  TreeDetectorOptions denser;
  denser.trees_per_km2 = 5000;
  EXPECT_EQ(refusal({"neural", model(), 1, denser}), "option-without-effect");
  EXPECT_EQ(refusal({"auto", model(), 1, denser}), "option-without-effect");
  EXPECT_EQ(refusal({"tree", {}, {}, denser}), "accepted");
  EXPECT_EQ(refusal({"tree", {}, 8, {}}), "option-without-effect");
}

TEST_F(MakeDetector, ReadsTheImageryOfMapsInFourOrientationsUnlessToldAndFramesInOne) {
  EXPECT_THAT(make_map_detector({"neural", model(), {}, {}})->describe(), ::testing::HasSubstr("orientations=4"));
  EXPECT_THAT(make_map_detector({"neural", model(), 1, {}})->describe(), ::testing::HasSubstr("orientations=1"));
  EXPECT_THAT(make_detector({"neural", model(), {}, {}}, SourceContent::kImagery)->describe(),
              ::testing::HasSubstr("orientations=1"));
  EXPECT_EQ(make_map_detector({"tree", {}, {}, {}})->describe().substr(0, 5), "tree ");
}

TEST_F(MakeDetector, EitherShippedNetworkFitsItsDescription) {
  const GroundImage image{cv::Mat(120, 90, CV_8UC3, cv::Scalar::all(90)), cv::Mat(120, 90, CV_8UC1, cv::Scalar(255)),
                          1.0};
  DetectorChoice choice;
  choice.name = "neural";
  std::set<std::string> descriptions;
  for (const SourceContent compared : {SourceContent::kImagery, SourceContent::kRoads}) {
    if (!default_model(compared)) GTEST_SKIP() << "models/roadnet*.onnx are not there";
    const auto detector = make_detector(choice, compared);
    EXPECT_NE(detector->describe().find("neural roadnet"), std::string::npos);
    EXPECT_EQ(detector->detect(image, 2.0, 1).observed_count(), 60U * 45U);
    descriptions.insert(detector->describe());
  }
  EXPECT_EQ(descriptions.size(), 2U);
}

TEST_F(MakeDetector, RefusesANameThatIsNoDetector) { EXPECT_EQ(refusal({"sift", {}, 1, {}}), "unknown-detector"); }

}  // namespace
}  // namespace roadfix
