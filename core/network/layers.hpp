// The layers of a convolutional network as its ONNX file lists them, of the few kinds that road networks consist of.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace roadfix {

/// Pairs are (rows, columns).
struct Convolution {
  int inputs = 0;   ///< channels
  int outputs = 0;  ///< channels
  std::array<int, 2> kernel{};
  std::array<int, 2> stride{};
  std::array<int, 2> dilation{};  ///< 1 = adjacent cells
  std::array<int, 2> before{};    ///< zero padding above and to the left,
  std::array<int, 2> after{};     ///< below and to the right
  std::vector<float> weights;     ///< outputs x inputs x kernel rows x kernel columns
  std::vector<float> bias;        ///< of each output
};

struct Layer {
  enum class Kind {
    kConvolution,  ///< of the first input; a second one, if any, is added to the result
    kSum,          ///< of two inputs
    kUpsample,     ///< nearest neighbour, to twice the rows and columns
    kConcat,       ///< the channels of all inputs, in their order
  };
  /// Stands for a layer as an input: the network's own input.
  static constexpr int kPicture = -1;

  Kind kind = Kind::kConvolution;
  std::vector<int> inputs{};  ///< indices of earlier layers, or kPicture
  int channels = 0;           ///< of the output
  bool relu = false;          ///< negative outputs become 0, after everything else; not of kConcat: oneDNN has no such
  Convolution convolution{};  ///< of kConvolution alone
};

/// The layers of an ONNX file with one input of 3 channels and one output, the last layer's, of 1 channel. nullopt for
/// a damaged file, and for one with nodes of other kinds or with attributes that Layer cannot express.
std::optional<std::vector<Layer>> read_layers(std::span<const unsigned char> onnx);

/// Rows and columns of the last layer's output for a picture of this size; nullopt where the inputs of a layer differ
/// in size, or a size is out of range.
std::optional<std::array<int, 2>> output_sides(std::span<const Layer> layers, std::array<int, 2> picture);

/// Rows and columns after a convolution; less than 1 where the kernel does not fit.
std::array<int, 2> sides_after(const Convolution& convolution, std::array<int, 2> sides);

}  // namespace roadfix
