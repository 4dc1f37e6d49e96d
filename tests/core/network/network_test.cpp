#include "core/network/network.hpp"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <opencv2/core.hpp>

#include "core/network/layers.hpp"
#include "core/network/onednn_network.hpp"
#include "core/network/opencv_network.hpp"
#include "core/units/file.hpp"
#include "tests/core/network/onnx_file.hpp"

namespace roadfix {
namespace {

using testing::OnnxFile;

cv::Mat random_picture(cv::Size size) {
  cv::Mat picture(size, CV_32FC3);
  cv::RNG(11).fill(picture, cv::RNG::NORMAL, 0.0, 1.0);
  return picture;
}

/// All kinds of layers as road networks have them: residuals, strips, and what lies beside the way down added on the
/// way up.
std::vector<unsigned char> road_network(unsigned seed) {
  OnnxFile file(seed);
  const auto residual = [&](const std::string& of, int channels, int dilation) {
    const std::string first =
        file.relu(file.convolution(of, {.inputs = channels, .outputs = channels, .dilation = dilation}));
    return file.relu(file.sum(of, file.convolution(first, {.inputs = channels, .outputs = channels})));
  };
  const auto strips = [&](const std::string& of, int channels) {
    const std::string few = file.convolution(of, {.inputs = channels, .outputs = 4, .kernel = {1, 1}});
    const std::string along = file.convolution(few, {.inputs = 4, .outputs = 5, .kernel = {1, 9}});
    const std::string across = file.relu(file.convolution(few, {.inputs = 4, .outputs = 3, .kernel = {9, 1}}));
    const std::string both = file.concat({along, across});
    return file.sum(of, file.relu(file.convolution(both, {.inputs = 8, .outputs = channels, .kernel = {1, 1}})));
  };
  const std::string fine = residual(
      file.relu(file.convolution("picture", {.inputs = 3, .outputs = 8, .kernel = {5, 5}, .stride = 2})), 8, 1);
  const std::string coarse =
      strips(residual(file.relu(file.convolution(fine, {.inputs = 8, .outputs = 20, .stride = 2})), 20, 2), 20);
  const std::string lifted =
      file.upsampled(file.relu(file.convolution(coarse, {.inputs = 20, .outputs = 8, .kernel = {1, 1}})));
  return file.bytes(
      file.convolution(residual(file.sum(fine, lifted), 8, 1), {.inputs = 8, .outputs = 1, .kernel = {1, 1}}));
}

TEST(Network, OneDnnAndOpenCvGiveTheSame) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto onnx = road_network(seed);
    auto layers = read_layers(onnx);
    ASSERT_TRUE(layers);
    OneDnnNetwork fast(std::move(*layers));
    OpenCvNetwork plain(onnx);
    for (const cv::Size size : {cv::Size(64, 48), cv::Size(36, 100), cv::Size(64, 48)}) {
      const cv::Mat picture = random_picture(size);
      const cv::Mat expected = plain.run(picture);
      ASSERT_EQ(fast.output_size(size), expected.size());
      EXPECT_LT(cv::norm(fast.run(picture), expected, cv::NORM_INF), 1e-4 * cv::norm(expected, cv::NORM_INF)) << seed;
    }
  }
}

/// Those of the source tree, which may be without them.
TEST(Network, TheShippedOnesAreOfLayersThatOneDnnRuns) {
  for (const char* name : {"roadnet.onnx", "roadnet-imagery.onnx"}) {
    const auto onnx = read_file(std::filesystem::path(ROADFIX_SOURCE_MODELS) / name);
    if (!onnx) GTEST_SKIP() << name << " is not there";
    const auto layers = read_layers({reinterpret_cast<const unsigned char*>(onnx->data()), onnx->size()});
    ASSERT_TRUE(layers) << name;
    EXPECT_EQ(output_sides(*layers, {64, 48}), (std::array{32, 24}));
  }
}

TEST(Network, ALayerMayBeAddedToWhatIsMadeOfIt) {
  OnnxFile file(5);
  const std::string first = file.convolution("picture", {.inputs = 3, .outputs = 16});
  const std::string sum = file.sum(first, file.convolution(first, {.inputs = 16, .outputs = 16}));
  const auto onnx = file.bytes(file.convolution(sum, {.inputs = 16, .outputs = 1}));
  const cv::Mat picture = random_picture({48, 32});
  const cv::Mat expected = OpenCvNetwork(onnx).run(picture);
  const cv::Mat found = OneDnnNetwork(read_layers(onnx).value()).run(picture);
  EXPECT_LT(cv::norm(found, expected, cv::NORM_INF), 1e-4 * cv::norm(expected, cv::NORM_INF));
}

TEST(Network, WhatIsConcatenatedMayBeRectified) {
  OnnxFile file(1);
  const OnnxFile::Shape six{.inputs = 3, .outputs = 6};
  const std::string both = file.relu(file.concat({file.convolution("picture", six), file.convolution("picture", six)}));
  const auto onnx = file.bytes(file.convolution(both, {.inputs = 12, .outputs = 1}));
  const cv::Mat picture = random_picture({32, 24});
  const cv::Mat expected = OpenCvNetwork(onnx).run(picture);
  EXPECT_LT(cv::norm(load_network(onnx)->run(picture), expected, cv::NORM_INF),
            1e-4 * cv::norm(expected, cv::NORM_INF));
}

TEST(Network, APictureMayBePartOfALargerOne) {
  const auto network = load_network(road_network(1));
  const cv::Mat large = random_picture({96, 80});
  const cv::Mat part = large(cv::Rect(16, 32, 64, 32));
  EXPECT_EQ(cv::norm(network->run(part), network->run(part.clone()), cv::NORM_INF), 0.0);
}

TEST(Network, GivesManyThreadsAtOnceWhatItGivesOne) {
  const auto network = load_network(road_network(2));
  const std::array sizes{cv::Size(32, 32), cv::Size(64, 32), cv::Size(64, 64)};
  std::vector<cv::Mat> alone;
  for (const cv::Size size : sizes) alone.push_back(network->run(random_picture(size)));
  std::vector<std::future<cv::Mat>> together;
  for (std::size_t i = 0; i < 24; ++i) {
    together.push_back(std::async(std::launch::async, [&, i] { return network->run(random_picture(sizes[i % 3])); }));
  }
  for (std::size_t i = 0; i < together.size(); ++i) {
    EXPECT_EQ(cv::norm(together[i].get(), alone[i % 3], cv::NORM_INF), 0.0) << i;
  }
}

TEST(Network, OpenCvRunsLayersOfOtherKinds) {
  OnnxFile file(3);
  const std::string logits = file.convolution("picture", {.inputs = 3, .outputs = 1, .stride = 2});
  const auto onnx = file.bytes(file.node("Sigmoid", {logits}).output(0));
  EXPECT_FALSE(read_layers(onnx));
  const cv::Mat answer = load_network(onnx)->run(random_picture({32, 16}));
  EXPECT_EQ(answer.size(), cv::Size(16, 8));
  EXPECT_TRUE(cv::checkRange(answer, true, nullptr, 0.0, 1.0));
}

/// Whether the system has refused, from now on, memory that can be written and run.
bool refuses_written_code() {
  constexpr int kSetMdwe = 65;  // of Linux 6.3, which Debian 12's headers do not have
  return prctl(kSetMdwe, 1UL, 0UL, 0UL, 0UL) == 0;
}

int answer_without_written_code() {
  constexpr int kNotKnown = 77;
  if (!refuses_written_code()) return kNotKnown;
  const cv::Mat answer = load_network(road_network(1))->run(random_picture({64, 32}));
  return answer.size() == cv::Size(32, 16) ? 0 : 1;
}

TEST(NetworkDeathTest, OpenCvRunsThemWhereTheSystemRefusesToRunWhatIsWritten) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto is_well = [](int status) {
    return WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 77);
  };
  EXPECT_EXIT(std::exit(answer_without_written_code()), is_well, "");
}

TEST(Network, RefusesSizesThatItsLayersDoNotFit) {
  OnnxFile file(4);
  const std::string half = file.convolution("picture", {.inputs = 3, .outputs = 2, .stride = 2});
  const std::string back = file.upsampled(file.convolution(half, {.inputs = 2, .outputs = 2, .stride = 2}));
  const auto onnx = file.bytes(file.convolution(file.sum(half, back), {.inputs = 2, .outputs = 1}));
  OneDnnNetwork network(read_layers(onnx).value());
  EXPECT_EQ(network.output_size({16, 8}), cv::Size(8, 4));
  EXPECT_THROW(network.output_size({18, 8}), cv::Exception);
}

TEST(Network, NoFileOfOnnxIsTaken) {
  const std::string text = "not a network";
  const std::vector<unsigned char> bytes(text.begin(), text.end());
  EXPECT_FALSE(read_layers(bytes));
  EXPECT_THROW(load_network(bytes), cv::Exception);
}

}  // namespace
}  // namespace roadfix
