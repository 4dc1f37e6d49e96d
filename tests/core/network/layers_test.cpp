#include "core/network/layers.hpp"

#include <gtest/gtest.h>

#include "tests/core/network/onnx_file.hpp"

namespace roadfix {
namespace {

using testing::OnnxFile;

TEST(NetworkLayers, OfANetworkTellWhatTheyTakeAndWhetherTheyAreRectified) {
  OnnxFile file(1);
  const std::string first = file.relu(file.convolution("picture", {.inputs = 3, .outputs = 4, .stride = 2}));
  const std::string second = file.convolution(first, {.inputs = 4, .outputs = 4, .dilation = 2});
  const std::string third = file.convolution(second, {.inputs = 4, .outputs = 4});
  const auto layers = read_layers(
      file.bytes(file.convolution(file.relu(file.sum(first, third)), {.inputs = 4, .outputs = 1, .kernel = {1, 1}})));
  ASSERT_TRUE(layers);
  ASSERT_EQ(layers->size(), 4U);
  EXPECT_EQ(layers->at(0).inputs, std::vector<int>{Layer::kPicture});
  EXPECT_TRUE(layers->at(0).relu);
  EXPECT_FALSE(layers->at(1).relu);
  EXPECT_EQ(layers->at(2).inputs, (std::vector<int>{1, 0})) << "the sum is the third convolution's";
  EXPECT_TRUE(layers->at(2).relu);
  EXPECT_FALSE(layers->at(3).relu);
  EXPECT_EQ(output_sides(*layers, {32, 20}), (std::array{16, 10}));
}

TEST(NetworkLayers, ASumOfAConvolutionThatIsRectifiedComesAfterwards) {
  OnnxFile file(1);
  const std::string first = file.convolution("picture", {.inputs = 3, .outputs = 1});
  const std::string second = file.relu(file.convolution(first, {.inputs = 1, .outputs = 1}));
  const auto layers = read_layers(file.bytes(file.sum(first, second)));
  ASSERT_TRUE(layers);
  ASSERT_EQ(layers->size(), 3U);
  EXPECT_EQ(layers->at(2).kind, Layer::Kind::kSum);
}

TEST(NetworkLayers, WhatOthersTakeUnrectifiedIsNotRectified) {
  OnnxFile file(1);
  const std::string shared = file.convolution("picture", {.inputs = 3, .outputs = 1});
  EXPECT_FALSE(read_layers(file.bytes(file.sum(shared, file.relu(shared)))));
}

/// A convolution whose description is changed after it was written.
template <typename Change>
bool reads(Change change) {
  OnnxFile file(1);
  const std::string output = file.convolution("picture", {.inputs = 3, .outputs = 1});
  change(file.graph());
  return read_layers(file.bytes(output)).has_value();
}

TEST(NetworkLayers, AreNotReadFromADamagedFile) {
  EXPECT_TRUE(reads([](onnx::GraphProto&) {}));
  EXPECT_FALSE(reads([](onnx::GraphProto& graph) { graph.mutable_initializer(0)->set_dims(1, 4); }));
  EXPECT_FALSE(reads([](onnx::GraphProto& graph) { graph.mutable_initializer(0)->set_dims(1, -3); }));
  EXPECT_FALSE(reads([](onnx::GraphProto& graph) { graph.mutable_initializer(0)->set_dims(2, 1L << 40); }));
  EXPECT_FALSE(
      reads([](onnx::GraphProto& graph) { graph.mutable_initializer(0)->mutable_float_data()->RemoveLast(); }));
  EXPECT_FALSE(reads([](onnx::GraphProto& graph) { graph.mutable_initializer(1)->clear_float_data(); }));
  EXPECT_FALSE(reads([](onnx::GraphProto& graph) { graph.mutable_node(0)->set_input(0, "nobody gives this"); }));
  EXPECT_FALSE(reads([](onnx::GraphProto& graph) { graph.mutable_node(0)->mutable_attribute(1)->set_ints(0, 0); }));
  EXPECT_FALSE(reads([](onnx::GraphProto& graph) { graph.mutable_node(0)->set_domain("someone.else"); }));
  EXPECT_FALSE(reads([](onnx::GraphProto& graph) { graph.add_input()->set_name("second"); }));
}

TEST(NetworkLayers, FitTogetherOnlyWhereWhatIsAddedHasOneSize) {
  OnnxFile file(1);
  const std::string half = file.convolution("picture", {.inputs = 3, .outputs = 1, .stride = 2});
  const std::string whole = file.convolution("picture", {.inputs = 3, .outputs = 1});
  const std::string doubled = file.upsampled(half);
  const auto layers = read_layers(file.bytes(file.sum(doubled, file.relu(whole))));
  ASSERT_TRUE(layers);
  EXPECT_TRUE(output_sides(*layers, {8, 6}));
  EXPECT_FALSE(output_sides(*layers, {7, 6}));
  EXPECT_FALSE(output_sides(*layers, {1 << 24, 6}));
}

}  // namespace
}  // namespace roadfix
