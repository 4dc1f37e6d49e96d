// The layers of a convolutional network as its ONNX file lists them, of the few kinds that road networks consist of.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace roadfix {

/// Pairs are of rows and columns.
struct Convolution {
  int inputs = 0;   ///< channels
  int outputs = 0;  ///< channels
  std::array<int, 2> kernel{};
  std::array<int, 2> stride{};
  std::array<int, 2> dilation{};  ///< 1 = cells beside each other
  std::array<int, 2> before{};    ///< zeros put above and on the left,
  std::array<int, 2> after{};     ///< below and on the right
  std::vector<float> weights;     ///< outputs x inputs x kernel rows x kernel columns
  std::vector<float> bias;        ///< of each output
};

struct Layer {
  enum class Kind {
    kConvolution,  ///< of the first input; a second one is added to it
    kSum,          ///< of two inputs
    kTwice,        ///< each cell becomes four
    kChannels,     ///< those of all inputs, one after the other
  };
  /// In place of a layer: what the network is given.
  static constexpr int kPicture = -1;

  Kind kind = Kind::kConvolution;
  std::vector<int> inputs{};  ///< indices of layers before this one, or kPicture
  int channels = 0;           ///< of what it gives
  bool rectified = false;     ///< what is negative becomes 0 in the end
  Convolution convolution{};  ///< of kConvolution alone
};

/// Of an ONNX file whose input has 3 channels and whose output, that of the last layer, has one. nullopt where it has
/// anything else in it, or is damaged.
std::optional<std::vector<Layer>> read_layers(std::span<const unsigned char> onnx);

/// Rows and columns of what the last layer gives for a picture with so many; nullopt where layers do not fit together.
std::optional<std::array<int, 2>> output_sides(std::span<const Layer> layers, std::array<int, 2> picture);

/// Rows and columns after a convolution, less than 1 where there is nothing left.
std::array<int, 2> sides_after(const Convolution& convolution, std::array<int, 2> sides);

}  // namespace roadfix
