// What little of a picture tells whether another one shows the same, though it was encoded anew, with other noise or
// brightness: for each of its parts whether it is lighter or darker than what lies around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace roadfix {

struct PictureSketch {
  static constexpr int kAcross = 64;  ///< parts along each side of the picture

  /// Row by row: 1 lighter, -1 darker, 0 neither.
  std::array<std::int8_t, std::size_t{kAcross} * kAcross> parts{};

  friend bool operator==(const PictureSketch&, const PictureSketch&) = default;
};

/// False where half of the picture or more is plain: what little is left of a calm sea may be text on the screen and
/// parts of the airframe, which stay in place.
bool is_same_picture(const PictureSketch& a, const PictureSketch& b);

}  // namespace roadfix
