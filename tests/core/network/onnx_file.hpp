// Writes ONNX files for tests: networks of random weights.
#pragma once

#include <onnx/onnx_pb.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace roadfix::testing {

class OnnxFile {
 public:
  explicit OnnxFile(unsigned seed) : random_(seed) {
    model_.set_ir_version(6);
    model_.add_opset_import()->set_version(11);
    graph().set_name("network");
    graph().add_input()->set_name("picture");
    set_shape(*graph().mutable_input(0), 3);
  }

  struct Shape {
    int inputs, outputs;
    std::array<int, 2> kernel{3, 3};
    int stride = 1;
    int dilation = 1;
  };
  /// Padded so that only the stride makes its output smaller. Each of these returns the name of its output.
  std::string convolution(const std::string& of, const Shape& shape) {
    onnx::NodeProto& node = this->node(
        "Conv", {of, tensor({shape.outputs, shape.inputs, shape.kernel[0], shape.kernel[1]}), tensor({shape.outputs})});
    const int down = shape.kernel[0] / 2 * shape.dilation;
    const int right = shape.kernel[1] / 2 * shape.dilation;
    add(node, "kernel_shape", {shape.kernel[0], shape.kernel[1]});
    add(node, "strides", {shape.stride, shape.stride});
    add(node, "dilations", {shape.dilation, shape.dilation});
    add(node, "pads", {down, right, down, right});
    return node.output(0);
  }
  std::string relu(const std::string& of) { return node("Relu", {of}).output(0); }
  std::string sum(const std::string& a, const std::string& b) { return node("Add", {a, b}).output(0); }
  std::string concat(const std::vector<std::string>& of) {
    onnx::NodeProto& node = this->node("Concat", of);
    onnx::AttributeProto& axis = *node.add_attribute();
    axis.set_name("axis");
    axis.set_type(onnx::AttributeProto::INT);
    axis.set_i(1);
    return node.output(0);
  }
  std::string upsampled(const std::string& of) {
    const std::string none = constant({});
    onnx::NodeProto& node = this->node("Resize", {of, none, constant({1, 1, 2, 2})});
    add_text(node, "mode", "nearest");
    add_text(node, "nearest_mode", "floor");
    add_text(node, "coordinate_transformation_mode", "asymmetric");
    return node.output(0);
  }
  onnx::NodeProto& node(const std::string& kind, const std::vector<std::string>& inputs) {
    onnx::NodeProto& node = *graph().add_node();
    node.set_op_type(kind);
    node.set_name(kind + std::to_string(graph().node_size()));
    for (const std::string& input : inputs) node.add_input(input);
    node.add_output(node.name() + "_output");
    return node;
  }

  onnx::GraphProto& graph() { return *model_.mutable_graph(); }
  /// The file, with the value of this name as its output.
  std::vector<unsigned char> bytes(const std::string& output) {
    graph().clear_output();
    graph().add_output()->set_name(output);
    set_shape(*graph().mutable_output(0), 1);
    const std::string text = model_.SerializeAsString();
    return {text.begin(), text.end()};
  }

 private:
  static void set_shape(onnx::ValueInfoProto& value, int channels) {
    onnx::TypeProto::Tensor& type = *value.mutable_type()->mutable_tensor_type();
    type.set_elem_type(onnx::TensorProto::FLOAT);
    for (const int side : {1, channels, 64, 64}) type.mutable_shape()->add_dim()->set_dim_value(side);
  }
  static void add(onnx::NodeProto& node, const std::string& name, const std::vector<std::int64_t>& numbers) {
    onnx::AttributeProto& attribute = *node.add_attribute();
    attribute.set_name(name);
    attribute.set_type(onnx::AttributeProto::INTS);
    for (const std::int64_t number : numbers) attribute.add_ints(number);
  }
  static void add_text(onnx::NodeProto& node, const std::string& name, const std::string& text) {
    onnx::AttributeProto& attribute = *node.add_attribute();
    attribute.set_name(name);
    attribute.set_type(onnx::AttributeProto::STRING);
    attribute.set_s(text);
  }
  std::string constant(const std::vector<float>& numbers) {
    onnx::NodeProto& node = this->node("Constant", {});
    onnx::AttributeProto& value = *node.add_attribute();
    value.set_name("value");
    value.set_type(onnx::AttributeProto::TENSOR);
    value.mutable_t()->set_data_type(onnx::TensorProto::FLOAT);
    value.mutable_t()->add_dims(static_cast<std::int64_t>(numbers.size()));
    for (const float number : numbers) value.mutable_t()->add_float_data(number);
    return node.output(0);
  }
  /// Of random numbers, so large that activations neither vanish nor grow from layer to layer.
  std::string tensor(const std::vector<int>& dims) {
    onnx::TensorProto& tensor = *graph().add_initializer();
    tensor.set_name("weights" + std::to_string(graph().initializer_size()));
    tensor.set_data_type(onnx::TensorProto::FLOAT);
    int count = 1;
    for (const int dim : dims) {
      tensor.add_dims(dim);
      count *= dim;
    }
    std::normal_distribution<float> weights(0.0F,
                                            1.0F / std::sqrt(static_cast<float>(count) / static_cast<float>(dims[0])));
    for (int i = 0; i < count; ++i) tensor.add_float_data(weights(random_));
    return tensor.name();
  }

  std::mt19937 random_;
  onnx::ModelProto model_;
};

}  // namespace roadfix::testing
