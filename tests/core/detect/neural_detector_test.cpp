#include "core/detect/neural_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "core/detect/network_picture.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/peak_memory.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kNetworks = ROADFIX_TEST_NETWORKS;

json tiny_description() {
  return json::parse(R"({ "name": "tiny", "gsd_m": 1.0, "stride": 2, "multiple": 16, "tile_px": 512, "overlap_px": 32,
    "channels": "rgb", "mean": [100, 110, 120], "std": [50, 60, 70], "output": "logits",
    "calibration": { "scale": 1.0, "bias": 0.0 } })");
}

/// A network of tests/core/detect/networks in a folder of its own, with the description given.
class NeuralDetector : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("roadfix_neural_" + std::string(info->name()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path model(const json& description, const std::string& network = "tiny.onnx") const {
    fs::path path = folder_ / "model.onnx";
    fs::copy_file(kNetworks / network, path, fs::copy_options::overwrite_existing);
    std::ofstream(folder_ / "model.json") << description.dump();
    return path;
  }

  std::string refusal(const json& description, const std::string& network = "tiny.onnx") const {
    return refusal(model(description, network));
  }

  static std::string refusal(const fs::path& path) {
    try {
      const NeuralRoadDetector detector(path);
    } catch (const InvalidInput& error) {
      return error.code();
    }
    return "accepted";
  }

  fs::path folder_;
};

GroundImage random_image(int cols, int rows, double gsd_m = 1.0) {
  GroundImage image{cv::Mat(rows, cols, CV_8UC3), cv::Mat(rows, cols, CV_8UC1, cv::Scalar(255)), gsd_m};
  cv::RNG(7).fill(image.pixels, cv::RNG::UNIFORM, 0, 256);
  return image;
}

TEST(NetworkPicture, TakesNoMoreMemoryThanItsPixelsAndFourPlanes) {
  if (ROADFIX_SANITIZED) GTEST_SKIP() << "a sanitizer keeps what was let go of";
  NetworkDescription network;
  network.local_contrast = LocalContrast{129, 8.0};
  network.rgb = true;
  network.multiple = 32;
  const GroundImage image = random_image(3000, 2010, network.gsd_m);
  const long before = testing::peak_memory_kib();
  const NetworkPicture picture = network_picture(image, network);
  EXPECT_EQ(picture.pixels.size(), cv::Size(3008, 2016));
  constexpr long kBytes = 3 * 4 + 4 * 4 + 5;  // per pixel; 5: masks
  EXPECT_LT(testing::peak_memory_kib() - before, kBytes * 3008 * 2016 / 1024);
}

/// What make_networks.py wrote into tiny.onnx, computed directly.
double tiny_probability(const cv::Mat& bgr, int cell_col, int cell_row) {
  const double mean[] = {100, 110, 120};
  const double std[] = {50, 60, 70};
  double logit = 0.25;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) {
      const cv::Point at(2 * cell_col + col - 1, 2 * cell_row + row - 1);
      if (at.x < 0 || at.y < 0 || at.x >= bgr.cols || at.y >= bgr.rows) continue;
      for (int channel = 0; channel < 3; ++channel) {
        const double value = (bgr.at<cv::Vec3b>(at)[2 - channel] - mean[channel]) / std[channel];
        logit += value * (channel + 1) * (3 * row + col - 3) / 60.0;
      }
    }
  }
  return 1.0 / (1.0 + std::exp(-logit));
}

/// Largest difference in steps of 1/254; an unobserved cell must meet an unobserved one.
int largest_difference(const CellArray& a, const CellArray& b) {
  EXPECT_EQ(a.cols(), b.cols());
  EXPECT_EQ(a.rows(), b.rows());
  int largest = 0;
  for (std::size_t i = 0; i < a.cells().size(); ++i) {
    if (is_observed(a.cells()[i]) != is_observed(b.cells()[i])) return 255;
    largest = std::max(largest, std::abs(a.cells()[i] - b.cells()[i]));
  }
  return largest;
}

TEST_F(NeuralDetector, AnswersWhatTheNetworksArithmeticSays) {
  const NeuralRoadDetector detector(model(tiny_description()));
  const GroundImage image = random_image(70, 45);
  const CellArray cells = detector.detect(image, 2.0, 1);
  ASSERT_EQ(cells.cols(), 35);
  ASSERT_EQ(cells.rows(), 23);
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      EXPECT_NEAR(cells.at(col, row), tiny_probability(image.pixels, col, row) * 254, 0.6) << col << " " << row;
    }
  }
}

TEST_F(NeuralDetector, SmallTilesAnswerLikeOnePass) {
  const GroundImage image = random_image(333, 270);
  const CellArray one_pass = NeuralRoadDetector(model(tiny_description())).detect(image, 2.0, 1);
  json small = tiny_description();
  small["tile_px"] = 64;
  EXPECT_LE(largest_difference(NeuralRoadDetector(model(small)).detect(image, 2.0, 1), one_pass), 1);
}

TEST_F(NeuralDetector, ShiftingTheTileGridDoesNotChangeTheInside) {
  json small = tiny_description();
  small["tile_px"] = 64;
  const NeuralRoadDetector detector(model(small));
  const GroundImage image = random_image(300, 200);
  const cv::Rect part(26, 14, 260, 180);
  const CellArray all = detector.detect(image, 2.0, 1);
  const CellArray shifted = detector.detect({image.pixels(part), image.observed(part), 1.0}, 2.0, 1);
  for (int row = 1; row < shifted.rows() - 1; ++row) {
    for (int col = 1; col < shifted.cols() - 1; ++col) {
      EXPECT_NEAR(shifted.at(col, row), all.at(col + 13, row + 7), 1);
    }
  }
}

TEST_F(NeuralDetector, WhatWasNotSeenStaysUnobservedAndDoesNotSpread) {
  const NeuralRoadDetector detector(model(tiny_description()));
  GroundImage image = random_image(64, 64);
  image.observed(cv::Rect(0, 0, 20, 64)).setTo(0);
  GroundImage other{image.pixels.clone(), image.observed, 1.0};
  other.pixels(cv::Rect(0, 0, 20, 64)).setTo(cv::Scalar(0, 255, 0));
  const CellArray cells = detector.detect(image, 2.0, 1);
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) EXPECT_EQ(is_observed(cells.at(col, row)), col >= 10);
  }
  EXPECT_EQ(cells, detector.detect(other, 2.0, 1));
}

TEST_F(NeuralDetector, APictureThatNobodySawIsUnobserved) {
  const NeuralRoadDetector detector(model(tiny_description()));
  GroundImage image = random_image(40, 40);
  image.observed.setTo(0);
  EXPECT_EQ(detector.detect(image, 2.0, 1).observed_count(), 0U);
}

TEST_F(NeuralDetector, BringsAPictureToTheNetworksScale) {
  const NeuralRoadDetector detector(model(tiny_description()));
  const GroundImage coarse = random_image(61, 47);
  GroundImage fine{{}, {}, 0.25};
  cv::resize(coarse.pixels, fine.pixels, {}, 4, 4, cv::INTER_NEAREST);
  cv::resize(coarse.observed, fine.observed, {}, 4, 4, cv::INTER_NEAREST);
  EXPECT_LE(largest_difference(detector.detect(fine, 2.0, 1), detector.detect(coarse, 2.0, 1)), 1);
}

TEST_F(NeuralDetector, ScaleIsExactWhereTheSidesAreNotWholePixelsOfTheNetwork) {
  // 0.3 m x 1001 = 300.3 m: stretching to 300 or 301 pixels would move the far end.
  const NeuralRoadDetector detector(model(tiny_description()));
  GroundImage image{cv::Mat(64, 1001, CV_8UC3, cv::Scalar::all(0)), cv::Mat(64, 1001, CV_8UC1, cv::Scalar(255)), 0.3};
  image.pixels.colRange(980, 1001).setTo(cv::Scalar::all(255));  // from 294.0 m on
  const CellArray cells = detector.detect(image, 1.0, 1);
  ASSERT_EQ(cells.cols(), 301);
  const auto first = [&](int col) { return cells.at(col, 9); };
  EXPECT_NEAR(first(285), first(200), 1);
  EXPECT_GT(std::abs(first(296) - first(285)), 40);
}

TEST_F(NeuralDetector, CoarserCellsAreMeansOfWhatWasSeen) {
  const NeuralRoadDetector detector(model(tiny_description()));
  const GroundImage image = random_image(64, 64);
  const CellArray fine = detector.detect(image, 2.0, 1);
  const CellArray coarse = detector.detect(image, 4.0, 1);
  ASSERT_EQ(coarse.cols(), 16);
  for (int row = 0; row < coarse.rows(); ++row) {
    for (int col = 0; col < coarse.cols(); ++col) {
      const int sum = fine.at(2 * col, 2 * row) + fine.at(2 * col + 1, 2 * row) + fine.at(2 * col, 2 * row + 1) +
                      fine.at(2 * col + 1, 2 * row + 1);
      EXPECT_NEAR(coarse.at(col, row), sum / 4.0, 1.1);
    }
  }
}

TEST_F(NeuralDetector, GreyPicturesAreAnsweredLikeTheirColourCopy) {
  const NeuralRoadDetector detector(model(tiny_description()));
  GroundImage grey{cv::Mat(48, 48, CV_8UC1), cv::Mat(48, 48, CV_8UC1, cv::Scalar(255)), 1.0};
  cv::RNG(3).fill(grey.pixels, cv::RNG::UNIFORM, 0, 256);
  cv::Mat colour;
  cv::merge(std::vector{grey.pixels, grey.pixels, grey.pixels}, colour);
  EXPECT_EQ(detector.detect(grey, 2.0, 1), detector.detect({colour, grey.observed, 1.0}, 2.0, 1));
}

TEST_F(NeuralDetector, WithLocalContrastBrightnessAndUnseenPixelsDoNotMatter) {
  json description = tiny_description();
  description["local_contrast"] = {{"window_px", 31}, {"floor", 0.001}};
  description["mean"] = {0, 0, 0};
  description["std"] = {1, 1, 1};
  const NeuralRoadDetector detector(model(description));
  GroundImage image = random_image(96, 80);
  image.observed.colRange(0, 30).setTo(0);
  cv::Mat quarter;
  image.pixels.convertTo(quarter, CV_8U, 0.25, 20.0);
  quarter.colRange(0, 30).setTo(cv::Scalar::all(255));
  EXPECT_LE(largest_difference(detector.detect({quarter, image.observed, 1.0}, 2.0, 1), detector.detect(image, 2.0, 1)),
            4);
}

TEST_F(NeuralDetector, EightOrientationsTurnWithThePicture) {
  const NeuralRoadDetector detector(model(tiny_description()), {8});
  const GroundImage image = random_image(64, 96);
  cv::Mat turned;
  cv::rotate(image.pixels, turned, cv::ROTATE_90_CLOCKWISE);
  const CellArray upright = detector.detect(image, 2.0, 1);
  const CellArray quarter = detector.detect({turned, cv::Mat(64, 96, CV_8UC1, cv::Scalar(255)), 1.0}, 2.0, 1);
  for (int row = 0; row < upright.rows(); ++row) {
    for (int col = 0; col < upright.cols(); ++col) {
      EXPECT_NEAR(quarter.at(upright.rows() - 1 - row, col), upright.at(col, row), 1);
    }
  }
}

TEST_F(NeuralDetector, CalibrationScalesTheLogits) {
  json description = tiny_description();
  const GroundImage image = random_image(32, 32);
  const CellArray plain = NeuralRoadDetector(model(description)).detect(image, 2.0, 1);
  description["calibration"] = {{"scale", 0.5}, {"bias", -1.0}};
  const CellArray calibrated = NeuralRoadDetector(model(description)).detect(image, 2.0, 1);
  const double p = probability(plain.at(5, 5));
  const double logit = 0.5 * std::log(p / (1 - p)) - 1.0;
  EXPECT_NEAR(probability(calibrated.at(5, 5)), 1 / (1 + std::exp(-logit)), 0.01);
}

TEST_F(NeuralDetector, ThreadsThatShareADetectorGetTheSameAnswer) {
  const NeuralRoadDetector detector(model(tiny_description()));
  const GroundImage image = random_image(128, 128);
  const CellArray alone = detector.detect(image, 2.0, 1);
  std::vector<std::future<CellArray>> answers;
  for (int i = 0; i < 6; ++i) {
    answers.push_back(std::async(std::launch::async, [&] { return detector.detect(image, 2.0, 1); }));
  }
  for (auto& answer : answers) EXPECT_EQ(answer.get(), alone);
}

TEST_F(NeuralDetector, EndsWhenAskedTo) {
  const NeuralRoadDetector detector(model(tiny_description()));
  std::stop_source stop;
  EXPECT_EQ(detector.detect(random_image(32, 32), 2.0, 1, stop.get_token()).observed_count(), 16U * 16U);
  stop.request_stop();
  EXPECT_EQ(testing::code_of([&] { detector.detect(random_image(32, 32), 2.0, 1, stop.get_token()); }),
            "detection-interrupted");
}

TEST_F(NeuralDetector, SaysWhichModelItRuns) {
  const NeuralRoadDetector detector(model(tiny_description()), {4});
  EXPECT_THAT(detector.describe(), ::testing::MatchesRegex("neural tiny fnv1a64=[0-9a-f]+ gsd_m=1 orientations=4"));
  EXPECT_EQ(detector.preferred_gsd_m(), 1.0);
  EXPECT_EQ(detector.halo_m(), 16.0);
}

TEST_F(NeuralDetector, RefusesWhatItCannotRun) {
  EXPECT_EQ(refusal(folder_ / "none.onnx"), "model-missing");
  EXPECT_EQ(refusal(folder_), "model-missing");
  EXPECT_EQ(refusal(tiny_description(), "two_channels.onnx"), "model-shape");
  EXPECT_EQ(refusal(tiny_description(), "full_size.onnx"), "model-shape");
  EXPECT_EQ(refusal(tiny_description(), "make_networks.py"), "model-unreadable");
  json other = tiny_description();
  other["fnv1a64"] = "0000000000000000";
  EXPECT_EQ(refusal(other), "model-checksum");
  fs::remove(folder_ / "model.json");
  EXPECT_EQ(refusal(folder_ / "model.onnx"), "model-description");
}

TEST_F(NeuralDetector, RefusesAMaskOfAnotherSize) {
  const NeuralRoadDetector detector(model(tiny_description()));
  GroundImage image = random_image(32, 32);
  image.observed = cv::Mat(16, 16, CV_8UC1, cv::Scalar(255));
  EXPECT_EQ(testing::code_of([&] { detector.detect(image, 2.0, 1); }), "image-shape");
}

}  // namespace
}  // namespace roadfix
