// PNG in memory, read by libpng itself: what the header says is known before a pixel is unpacked, and nothing is
// printed. libpng leaves by longjmp where something is wrong; here that becomes an error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace roadfix {

struct PngShape {
  int cols = 0;
  int rows = 0;
  int channels = 1;
  int bits = 8;  ///< of each channel: 8 or 16

  /// Size of the pixels, row by row without gaps.
  std::size_t bytes() const;
  friend bool operator==(const PngShape&, const PngShape&) = default;
};

enum class PngOrigin {
  /// A plain grey image as encode_plain_png() writes them: anything else is refused. 16 bits are big-endian, as they
  /// are stored.
  kOwn,
  /// Any program: pixels as OpenCV keeps them. Grey, BGR or BGR with alpha; palettes are looked up, and a colour that
  /// stands for nothing (tRNS) is transparent. 16 bits are in the processor's order.
  kOutside,
};

/// What stands beside the pixels is passed over: a kilobyte of text may unpack to megabytes.
class PngReader {
 public:
  /// Reads up to the pixels of `png`, which is used again in read(). Throws CorruptData "png-damaged", which says what
  /// is wrong.
  PngReader(std::span<const std::byte> png, PngOrigin origin);
  ~PngReader();
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// The shape of what read() gives.
  const PngShape& shape() const;
  /// Once, to the end of the image; `pixels` has shape().bytes(). Throws as the constructor does.
  void read(std::span<std::uint8_t> pixels);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadfix
