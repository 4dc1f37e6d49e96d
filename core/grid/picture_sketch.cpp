#include "core/grid/picture_sketch.hpp"

#include <algorithm>
#include <cstddef>

namespace roadfix {

bool is_same_picture(const PictureSketch& a, const PictureSketch& b) {
  // Text on the screen marks 0.37 of a calm sea; text, a letter box, a ring and a part of the airframe 0.48.
  constexpr double kMinMarkedShare = 0.5;
  // JPEG of quality 30, noise of 10 levels and 18 numbers that change leave 0.93. After 3 m of flight over 300 m of
  // ground it is at most 0.74, text that stays in place included.
  constexpr double kMinAgreement = 0.9;
  int agreement = 0;
  int marked_a = 0;
  int marked_b = 0;
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    agreement += a.parts[i] * b.parts[i];
    marked_a += a.parts[i] * a.parts[i];
    marked_b += b.parts[i] * b.parts[i];
  }
  return std::min(marked_a, marked_b) >= kMinMarkedShare * static_cast<double>(a.parts.size()) &&
         agreement >= kMinAgreement * std::max(marked_a, marked_b);
}

}  // namespace roadfix
