#include "core/network/network.hpp"

#include "core/network/layers.hpp"
#include "core/network/onednn_network.hpp"
#include "core/network/onednn_plan.hpp"
#include "core/network/opencv_network.hpp"

namespace roadfix {

std::unique_ptr<Network> load_network(std::span<const unsigned char> onnx) {
  if (onednn_suits()) {
    if (auto layers = read_layers(onnx)) return std::make_unique<OneDnnNetwork>(std::move(*layers));
  }
  return std::make_unique<OpenCvNetwork>(onnx);
}

}  // namespace roadfix
