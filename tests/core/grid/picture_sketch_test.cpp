#include "core/grid/picture_sketch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "tests/support/sketches.hpp"

namespace roadfix {
namespace {

using testing::random_sketch;
using testing::with_parts_changed;

TEST(PictureSketch, IsOfTheSamePictureThoughAFewOfItsPartsDiffer) {
  const PictureSketch sketch = random_sketch(1);
  EXPECT_TRUE(is_same_picture(sketch, sketch));
  EXPECT_TRUE(is_same_picture(sketch, with_parts_changed(sketch, 0.04)));
  EXPECT_FALSE(is_same_picture(sketch, with_parts_changed(sketch, 0.06))) << "each counts twice";
  EXPECT_FALSE(is_same_picture(sketch, random_sketch(2)));
}

TEST(PictureSketch, OfAPictureThatIsHalfPlainTellsNothing) {
  PictureSketch sketch = random_sketch(1);
  const auto plain = [&](std::size_t count) { std::fill_n(sketch.parts.begin(), count, std::int8_t{0}); };
  plain(sketch.parts.size() / 2);
  EXPECT_TRUE(is_same_picture(sketch, sketch));
  plain(sketch.parts.size() / 2 + 1);
  EXPECT_FALSE(is_same_picture(sketch, sketch));
  EXPECT_FALSE(is_same_picture({}, {}));
}

}  // namespace
}  // namespace roadfix
