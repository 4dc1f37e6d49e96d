#include "core/network/layers.hpp"

#include <onnx/onnx_pb.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

namespace roadfix {
namespace {

static_assert(std::endian::native == std::endian::little, "as raw data of tensors are");

constexpr int kPictureChannels = 3;
constexpr int kMaxChannels = 4096;
constexpr int kMaxSide = 1 << 20;

struct Unsupported {};

void require(bool supported) {
  if (!supported) throw Unsupported{};
}

const onnx::AttributeProto* attribute(const onnx::NodeProto& node, std::string_view name) {
  const auto found = std::ranges::find(node.attribute(), name, &onnx::AttributeProto::name);
  return found == node.attribute().end() ? nullptr : &*found;
}

bool says(const onnx::NodeProto& node, std::string_view name, std::string_view text) {
  const onnx::AttributeProto* found = attribute(node, name);
  return found != nullptr && found->s() == text;
}

/// The attribute's counts of cells, each at least `min`; all `otherwise` where the node does not have it.
template <std::size_t kSize>
std::array<int, kSize> cells(const onnx::NodeProto& node, std::string_view name, int min, int otherwise) {
  constexpr std::int64_t kMax = 64;
  std::array<int, kSize> result{};
  result.fill(otherwise);
  const onnx::AttributeProto* found = attribute(node, name);
  if (found == nullptr) return result;
  require(found->ints_size() == int{kSize});
  for (std::size_t i = 0; i < kSize; ++i) {
    const std::int64_t count = found->ints(static_cast<int>(i));
    require(count >= min && count <= kMax);
    result[i] = static_cast<int>(count);
  }
  return result;
}

std::vector<float> numbers(const onnx::TensorProto& tensor) {
  require(tensor.data_type() == onnx::TensorProto::FLOAT && tensor.data_location() == onnx::TensorProto::DEFAULT);
  if (!tensor.has_raw_data()) return {tensor.float_data().begin(), tensor.float_data().end()};
  std::vector<float> result(tensor.raw_data().size() / sizeof(float));
  std::memcpy(result.data(), tensor.raw_data().data(), result.size() * sizeof(float));
  return result;
}

Convolution convolution_of(const onnx::NodeProto& node, const onnx::TensorProto& weights,
                           const onnx::TensorProto& bias) {
  require(weights.dims_size() == 4);
  for (const std::int64_t dimension : weights.dims()) require(dimension >= 1 && dimension <= kMaxChannels);
  const auto dimension = [&](int index) { return static_cast<int>(weights.dims(index)); };
  const onnx::AttributeProto* group = attribute(node, "group");
  require((group == nullptr || group->i() == 1) && attribute(node, "auto_pad") == nullptr);
  const auto pads = cells<4>(node, "pads", 0, 0);
  Convolution result{.inputs = dimension(1),
                     .outputs = dimension(0),
                     .kernel = cells<2>(node, "kernel_shape", 1, 0),
                     .stride = cells<2>(node, "strides", 1, 1),
                     .dilation = cells<2>(node, "dilations", 1, 1),
                     .before = {pads[0], pads[1]},
                     .after = {pads[2], pads[3]},
                     .weights = numbers(weights),
                     .bias = numbers(bias)};
  require(result.kernel == std::array{dimension(2), dimension(3)} && std::ssize(result.bias) == result.outputs);
  require(std::ssize(result.weights) ==
          std::ptrdiff_t{result.outputs} * result.inputs * result.kernel[0] * result.kernel[1]);
  return result;
}

/// Takes the nodes in their order: ONNX says that each comes after those whose outputs it takes.
class Reader {
 public:
  explicit Reader(const onnx::GraphProto& graph) : graph_(graph) {
    for (const onnx::TensorProto& tensor : graph.initializer()) constants_[tensor.name()] = &tensor;
    for (const onnx::ValueInfoProto& input : graph.input()) {
      if (!constants_.contains(input.name())) set_layer(input.name(), Layer::kPicture);
    }
    require(layer_of_.size() == 1 && graph.output_size() == 1);
    for (const onnx::NodeProto& node : graph.node()) {
      for (const std::string& input : node.input()) ++consumers_[input];
    }
    ++consumers_[graph.output(0).name()];
  }

  std::vector<Layer> read() {
    for (const onnx::NodeProto& node : graph_.node()) read(node);
    require(!layers_.empty() && layer(graph_.output(0).name()) == last() && layers_.back().channels == 1);
    return std::move(layers_);
  }

 private:
  void read(const onnx::NodeProto& node) {
    const std::string& kind = node.op_type();
    require(node.domain().empty() && node.output_size() == 1);
    if (kind == "Constant") return read_constant(node);
    if (kind == "Conv") return read_convolution(node);
    if (kind == "Relu") return read_relu(node);
    if (kind == "Add") return read_sum(node);
    if (kind == "Concat") return read_concat(node);
    require(kind == "Resize");
    read_upsampling(node);
  }

  void read_constant(const onnx::NodeProto& node) {
    const onnx::AttributeProto* value = attribute(node, "value");
    require(value != nullptr);
    constants_[node.output(0)] = &value->t();
  }

  void read_convolution(const onnx::NodeProto& node) {
    require(node.input_size() == 3);
    const int from = layer(node.input(0));
    Convolution read = convolution_of(node, constant(node.input(1)), constant(node.input(2)));
    require(read.inputs == channels(from));
    add({Layer::Kind::kConvolution, {from}, read.outputs, false, std::move(read)}, node);
  }

  /// Becomes part of the layer that it follows, which must have no other consumer.
  void read_relu(const onnx::NodeProto& node) {
    require(node.input_size() == 1);
    const int of = layer(node.input(0));
    require(of != Layer::kPicture && consumers_[node.input(0)] == 1);
    Layer& rectified = layers_[static_cast<std::size_t>(of)];
    require(rectified.kind != Layer::Kind::kConcat);
    rectified.relu = true;
    set_layer(node.output(0), of);
  }

  /// Becomes part of the convolution just before it if that has no other consumer. A convolution's own input is not
  /// added so: it would be overwritten while it is still read.
  void read_sum(const onnx::NodeProto& node) {
    require(node.input_size() == 2);
    std::array<int, 2> from{layer(node.input(0)), layer(node.input(1))};
    require(channels(from[0]) == channels(from[1]) && from[0] != from[1]);
    if (from[0] > from[1]) std::swap(from[0], from[1]);
    const bool after_convolution = from[0] != Layer::kPicture && from[1] == last() &&
                                   layers_.back().kind == Layer::Kind::kConvolution && !layers_.back().relu &&
                                   layers_.back().inputs.size() == 1 && consumers_of_last() == 1 &&
                                   layers_.back().inputs.front() != from[0];
    if (after_convolution) {
      layers_.back().inputs.push_back(from[0]);
      set_layer(node.output(0), last());
    } else {
      add({Layer::Kind::kSum, {from[0], from[1]}, channels(from[0])}, node);
    }
  }

  void read_concat(const onnx::NodeProto& node) {
    const onnx::AttributeProto* axis = attribute(node, "axis");
    require(axis != nullptr && axis->i() == 1 && node.input_size() >= 2);
    Layer made{.kind = Layer::Kind::kConcat};
    for (const std::string& input : node.input()) {
      made.inputs.push_back(layer(input));
      made.channels += channels(made.inputs.back());
      require(made.channels <= kMaxChannels);
    }
    add(std::move(made), node);
  }

  void read_upsampling(const onnx::NodeProto& node) {
    require(node.input_size() == 3 && says(node, "mode", "nearest") && says(node, "nearest_mode", "floor") &&
            says(node, "coordinate_transformation_mode", "asymmetric"));
    require(numbers(constant(node.input(2))) == std::vector<float>{1, 1, 2, 2});
    const int from = layer(node.input(0));
    add({Layer::Kind::kUpsample, {from}, channels(from)}, node);
  }

  void add(Layer made, const onnx::NodeProto& node) {
    layers_.push_back(std::move(made));
    set_layer(node.output(0), last());
    name_of_last_ = node.output(0);
  }

  void set_layer(const std::string& name, int layer) { require(layer_of_.emplace(name, layer).second); }
  int consumers_of_last() { return consumers_[name_of_last_]; }
  int last() const { return static_cast<int>(layers_.size()) - 1; }

  int layer(const std::string& name) const {
    const auto found = layer_of_.find(name);
    require(found != layer_of_.end());
    return found->second;
  }

  int channels(int layer) const {
    return layer == Layer::kPicture ? kPictureChannels : layers_[static_cast<std::size_t>(layer)].channels;
  }

  const onnx::TensorProto& constant(const std::string& name) const {
    const auto found = constants_.find(name);
    require(found != constants_.end());
    return *found->second;
  }

  const onnx::GraphProto& graph_;
  std::map<std::string, const onnx::TensorProto*> constants_;
  std::map<std::string, int> layer_of_;   ///< which layer computes the value of this name
  std::map<std::string, int> consumers_;  ///< how many nodes take the value of this name
  std::vector<Layer> layers_;
  std::string name_of_last_;  ///< output of the node that the last layer began with
};

}  // namespace

std::optional<std::vector<Layer>> read_layers(std::span<const unsigned char> onnx) {
  onnx::ModelProto model;
  if (!model.ParseFromArray(onnx.data(), static_cast<int>(onnx.size()))) return std::nullopt;
  try {
    return Reader(model.graph()).read();
  } catch (const Unsupported&) {
    return std::nullopt;
  }
}

std::array<int, 2> sides_after(const Convolution& convolution, std::array<int, 2> sides) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int reach = convolution.dilation[axis] * (convolution.kernel[axis] - 1) + 1;
    const int room = sides[axis] + convolution.before[axis] + convolution.after[axis] - reach;
    sides[axis] = room < 0 ? 0 : room / convolution.stride[axis] + 1;
  }
  return sides;
}

std::optional<std::array<int, 2>> output_sides(std::span<const Layer> layers, std::array<int, 2> picture) {
  std::vector<std::array<int, 2>> made;
  const auto given = [&](int layer) {
    return layer == Layer::kPicture ? picture : made[static_cast<std::size_t>(layer)];
  };
  for (const Layer& layer : layers) {
    std::array<int, 2> sides = given(layer.inputs.front());
    if (layer.kind == Layer::Kind::kConvolution) sides = sides_after(layer.convolution, sides);
    if (layer.kind == Layer::Kind::kUpsample) sides = {2 * sides[0], 2 * sides[1]};
    if (std::ranges::min(sides) < 1 || std::ranges::max(sides) > kMaxSide) return std::nullopt;
    for (const int other : std::span(layer.inputs).subspan(1)) {
      if (given(other) != sides) return std::nullopt;
    }
    made.push_back(sides);
  }
  return made.back();
}

}  // namespace roadfix
