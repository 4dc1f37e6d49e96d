#include "core/network/onednn_plan.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

// Of OpenMP, which Debian's oneDNN runs on; Clang has no <omp.h> of its own there.
extern "C" void omp_set_num_threads(int threads);

namespace roadfix {
namespace {

using dnnl::memory;
using Dims = memory::dims;
constexpr auto kFloat = memory::data_type::f32;

const dnnl::engine& processor() {
  static const dnnl::engine engine(dnnl::engine::kind::cpu, 0);
  return engine;
}

/// The callers are threads already, and OpenMP's would wait for each other in busy loops.
void stay_in_this_thread() { omp_set_num_threads(1); }

memory::desc in_any_layout(const Dims& dims) { return {dims, kFloat, memory::format_tag::any}; }

memory::desc bytes(std::size_t count) {
  return {{static_cast<memory::dim>(count)}, memory::data_type::u8, memory::format_tag::a};
}

Dims dims_of(const std::array<int, 2>& pair) { return {pair[0], pair[1]}; }

Dims dims_after(const Convolution& by, const Dims& dims) {
  const auto sides = sides_after(by, {static_cast<int>(dims[2]), static_cast<int>(dims[3])});
  return {1, by.outputs, sides[0], sides[1]};
}

using ConvolutionPrimitive = dnnl::convolution_forward::primitive_desc;

/// Winograd's algorithm, which takes fewer products, where oneDNN has it for this convolution and processor.
ConvolutionPrimitive convolution_primitive(const Convolution& by, const Dims& from, const dnnl::primitive_attr& how) {
  const Dims gaps{by.dilation[0] - 1, by.dilation[1] - 1};
  const auto of = [&](dnnl::algorithm algorithm, bool may_fail) {
    const dnnl::convolution_forward::desc asked(dnnl::prop_kind::forward_inference, algorithm, in_any_layout(from),
                                                in_any_layout({by.outputs, by.inputs, by.kernel[0], by.kernel[1]}),
                                                in_any_layout({by.outputs}), in_any_layout(dims_after(by, from)),
                                                dims_of(by.stride), gaps, dims_of(by.before), dims_of(by.after));
    return ConvolutionPrimitive(asked, how, processor(), may_fail);
  };
  ConvolutionPrimitive fast = of(dnnl::algorithm::convolution_winograd, true);
  return fast ? fast : of(dnnl::algorithm::convolution_direct, false);
}

}  // namespace

/// Adds the steps of one layer after the other. A buffer is used again once its last reader has been added.
class OneDnnPlan::Builder {
 public:
  Builder(OneDnnPlan& plan, std::span<const Layer> layers, OneDnnConstants& constants)
      : plan_(plan), layers_(layers), constants_(constants), last_reader_(layers.size()) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      last_reader_[i] = layers.size();
      for (const int input : layers[i].inputs) {
        if (input != Layer::kPicture) last_reader_[static_cast<std::size_t>(input)] = i;
      }
    }
  }

  void build() {
    plan_.picture_ =
        allocated({{1, 3, plan_.size_.height, plan_.size_.width}, kFloat, memory::format_tag::nhwc}).memory;
    for (const Layer& layer : layers_) {
      outputs_.push_back(added_layer(layer));
      release_buffers();
    }
    const memory& last = outputs_.back().memory;
    plan_.result_ = reordered(last, {last.get_desc().dims(), kFloat, memory::format_tag::nchw});
    const memory scratch(bytes(scratch_bytes_), processor());
    for (Step& step : plan_.steps_) step.arguments.emplace(DNNL_ARG_SCRATCHPAD, scratch);
  }

 private:
  struct Value {
    dnnl::memory memory;
    std::size_t buffer = 0;
  };

  Value added_layer(const Layer& layer) {
    switch (layer.kind) {
      case Layer::Kind::kConvolution:
        return convolution(layer);
      case Layer::Kind::kSum:
        return sum(layer);
      case Layer::Kind::kUpsample:
        return upsampling(layer);
      case Layer::Kind::kConcat:
        break;
    }
    return concatenation(layer);
  }

  Value convolution(const Layer& layer) {
    const Convolution& by = layer.convolution;
    const memory& from = input(layer, 0);
    const bool adds = layer.inputs.size() > 1;
    const ConvolutionPrimitive found = convolution_primitive(by, from.get_desc().dims(), attributes(layer, adds));
    const Dims weights{by.outputs, by.inputs, by.kernel[0], by.kernel[1]};
    std::unordered_map<int, memory> arguments{
        {DNNL_ARG_SRC, reordered(from, found.src_desc())},
        {DNNL_ARG_WEIGHTS,
         constants_.reordered(by.weights, {weights, kFloat, memory::format_tag::oihw}, found.weights_desc())},
        {DNNL_ARG_BIAS,
         constants_.reordered(by.bias, {{by.outputs}, kFloat, memory::format_tag::x}, found.bias_desc())}};
    Value to = adds ? accumulator(layer.inputs[1], found.dst_desc()) : allocated(found.dst_desc());
    return added<dnnl::convolution_forward>(found, std::move(arguments), std::move(to));
  }

  Value sum(const Layer& layer) {
    const memory& first = input(layer, 0);
    const memory second = reordered(input(layer, 1), first.get_desc());
    const dnnl::binary::desc asked(dnnl::algorithm::binary_add, first.get_desc(), second.get_desc(), first.get_desc());
    const dnnl::binary::primitive_desc found(asked, attributes(layer), processor());
    return added<dnnl::binary>(found, {{DNNL_ARG_SRC_0, first}, {DNNL_ARG_SRC_1, second}}, allocated(found.dst_desc()));
  }

  Value upsampling(const Layer& layer) {
    const memory& from = input(layer, 0);
    Dims dims = from.get_desc().dims();
    dims[2] *= 2;
    dims[3] *= 2;
    const dnnl::resampling_forward::desc asked(dnnl::prop_kind::forward_inference, dnnl::algorithm::resampling_nearest,
                                               from.get_desc(), in_any_layout(dims));
    const dnnl::resampling_forward::primitive_desc found(asked, attributes(layer), processor());
    return added<dnnl::resampling_forward>(found, {{DNNL_ARG_SRC, from}}, allocated(found.dst_desc()));
  }

  Value concatenation(const Layer& layer) {
    std::vector<memory::desc> parts;
    std::unordered_map<int, memory> arguments;
    for (std::size_t i = 0; i < layer.inputs.size(); ++i) {
      parts.push_back(input(layer, i).get_desc());
      arguments.emplace(DNNL_ARG_MULTIPLE_SRC + static_cast<int>(i), input(layer, i));
    }
    const dnnl::concat::primitive_desc found(1, parts, processor(), attributes(layer));
    return added<dnnl::concat>(found, std::move(arguments), allocated(found.dst_desc()));
  }

  static dnnl::primitive_attr attributes(const Layer& layer, bool adds = false) {
    dnnl::post_ops after;
    if (adds) after.append_sum();
    if (layer.relu) after.append_eltwise(1.0F, dnnl::algorithm::eltwise_relu, 0.0F, 0.0F);
    dnnl::primitive_attr result;
    result.set_scratchpad_mode(dnnl::scratchpad_mode::user);
    result.set_post_ops(after);
    return result;
  }

  const memory& input(const Layer& layer, std::size_t index) const {
    const int from = layer.inputs[index];
    return from == Layer::kPicture ? plan_.picture_ : outputs_[static_cast<std::size_t>(from)].memory;
  }

  template <typename Primitive, typename Description>
  Value added(const Description& found, std::unordered_map<int, memory> arguments, Value to) {
    scratch_bytes_ = std::max(scratch_bytes_, found.scratchpad_desc().get_size());
    arguments.emplace(DNNL_ARG_DST, to.memory);
    plan_.steps_.push_back({Primitive(found), std::move(arguments)});
    return to;
  }

  /// The same values in another layout, for the next step only.
  memory reordered(const memory& from, const memory::desc& layout) {
    if (from.get_desc() == layout) return from;
    Value to = allocated(layout);
    temporaries_.push_back(to.buffer);
    return copied(from, std::move(to)).memory;
  }

  /// A layer's output in this layout, which the new layer may overwrite: in place if nobody else will read it.
  Value accumulator(int layer, const memory::desc& layout) {
    const Value& from = outputs_[static_cast<std::size_t>(layer)];
    if (from.memory.get_desc() == layout && last_reader_[static_cast<std::size_t>(layer)] == outputs_.size()) {
      last_reader_[static_cast<std::size_t>(layer)] = layers_.size();  // its buffer is the new layer's from now on
      return from;
    }
    return copied(from.memory, allocated(layout));
  }

  Value copied(const memory& from, Value to) {
    const dnnl::reorder::primitive_desc found(processor(), from.get_desc(), processor(), to.memory.get_desc(),
                                              attributes({}));
    return added<dnnl::reorder>(found, {{DNNL_ARG_FROM, from}}, std::move(to));
  }

  /// In the smallest free buffer that is large enough, or in a new one.
  Value allocated(const memory::desc& desc) {
    const auto size = [&](std::size_t buffer) { return plan_.buffers_[buffer].get_desc().get_size(); };
    std::optional<std::size_t> best;
    for (const std::size_t buffer : free_buffers_) {
      if (size(buffer) >= desc.get_size() && (!best || size(buffer) < size(*best))) best = buffer;
    }
    if (best) {
      std::erase(free_buffers_, *best);
    } else {
      best = plan_.buffers_.size();
      plan_.buffers_.emplace_back(bytes(desc.get_size()), processor());
    }
    return {memory(desc, processor(), plan_.buffers_[*best].get_data_handle()), *best};
  }

  void release_buffers() {
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      if (last_reader_[i] == outputs_.size() - 1) free_buffers_.push_back(outputs_[i].buffer);
    }
    free_buffers_.insert(free_buffers_.end(), temporaries_.begin(), temporaries_.end());
    temporaries_.clear();
  }

  OneDnnPlan& plan_;
  std::span<const Layer> layers_;
  OneDnnConstants& constants_;
  std::vector<std::size_t> last_reader_;   ///< of each layer: the index of a layer, or their number if there is none
  std::vector<Value> outputs_;             ///< of each layer so far
  std::vector<std::size_t> free_buffers_;  ///< indices
  std::vector<std::size_t> temporaries_;   ///< indices of buffers that are free after the layer being added
  std::size_t scratch_bytes_ = 1;
};

memory OneDnnConstants::reordered(const std::vector<float>& values, const memory::desc& given,
                                  const memory::desc& layout) {
  const std::scoped_lock lock(mutex_);
  const auto same = [&](const Constant& known) {
    return known.values == values.data() && known.memory.get_desc() == layout;
  };
  if (const auto known = std::ranges::find_if(known_, same); known != known_.end()) return known->memory;
  memory from(given, processor(), const_cast<float*>(values.data()));
  memory to(layout, processor());
  dnnl::stream stream(processor());
  dnnl::reorder(from, to).execute(stream, from, to);
  stream.wait();
  known_.push_back({values.data(), to});
  return to;
}

OneDnnPlan::OneDnnPlan(std::span<const Layer> layers, cv::Size size, OneDnnConstants& constants)
    : size_(size), stream_(processor()) {
  stay_in_this_thread();
  Builder(*this, layers, constants).build();
}

cv::Mat OneDnnPlan::run(const cv::Mat& picture) {
  CV_Assert(picture.type() == CV_32FC3 && picture.size() == size_);
  stay_in_this_thread();
  picture.copyTo(cv::Mat(size_, CV_32FC3, picture_.get_data_handle()));
  for (const Step& step : steps_) step.primitive.execute(stream_, step.arguments);
  stream_.wait();
  const Dims dims = result_.get_desc().dims();
  return cv::Mat(static_cast<int>(dims[2]), static_cast<int>(dims[3]), CV_32FC1, result_.get_data_handle()).clone();
}

bool onednn_suits() {
  static const bool suits = [] {
    const dnnl::cpu_isa isa = dnnl::get_effective_cpu_isa();
    if (isa == dnnl::cpu_isa::all || isa < dnnl::cpu_isa::avx2) return false;
    Layer layer{.inputs = {Layer::kPicture}, .channels = 1};
    layer.convolution = {.inputs = 3,
                         .outputs = 1,
                         .kernel = {1, 1},
                         .stride = {1, 1},
                         .dilation = {1, 1},
                         .weights = {0.0F, 0.0F, 0.0F},
                         .bias = {0.0F}};
    OneDnnConstants constants;
    try {
      OneDnnPlan({&layer, 1}, {16, 16}, constants).run(cv::Mat::zeros(16, 16, CV_32FC3));
    } catch (const dnnl::error&) {
      return false;
    }
    return true;
  }();
  return suits;
}

}  // namespace roadfix
