#include "core/detect/lens.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

const cv::Point2d kPrincipal(320.0, 240.0);

Lens barrel() { return {300.0, kPrincipal, LensModel::kPerspective, {-0.25, 0.06, 0.001, -0.002, -0.004}}; }
Lens fisheye() { return {220.0, kPrincipal, LensModel::kFisheye, {0.02, -0.01, 0.003, -0.0005}}; }

TEST(Lens, FindsTheRayOfAPixelThatItDrew) {
  for (const Lens& lens : {barrel(), fisheye(), Lens(300.0, kPrincipal, LensModel::kPerspective, {})}) {
    for (const cv::Point2d ray : {cv::Point2d(0, 0), {0.5, 0.1}, {-0.8, 0.6}, {0.02, -0.9}}) {
      ASSERT_TRUE(lens.within(ray));
      const auto found = lens.ray_of(lens.pixels_of({ray}).front());
      ASSERT_TRUE(found) << ray;
      EXPECT_LT(cv::norm(*found - ray), 1e-5) << ray;
    }
  }
}

TEST(Lens, OfAFisheyeWithoutFurtherTermsDrawsAngles) {
  const Lens lens(220.0, kPrincipal, LensModel::kFisheye, {0, 0, 0, 0});
  EXPECT_LT(cv::norm(lens.pixels_of({{std::tan(1.0), 0.0}}).front() - cv::Point2d(540.0, 240.0)), 1e-9);
  EXPECT_FALSE(lens.ray_of({320.0 + 220.0 * 1.6, 240.0})) << "looks behind itself";
}

TEST(Lens, EndsWhereItWouldFoldRaysBack) {
  const Lens lens(300.0, kPrincipal, LensModel::kPerspective, {-0.5, 0, 0, 0});  // r - r^3 / 2 grows up to r = 0.816
  EXPECT_TRUE(lens.within({0.80, 0.0}));
  EXPECT_FALSE(lens.within({0.0, -0.83}));
  EXPECT_TRUE(lens.ray_of({320.0 + 300.0 * 0.5, 240.0}));
  EXPECT_FALSE(lens.ray_of({320.0 + 300.0 * 0.6, 240.0})) << "no ray ends beyond 0.544";
}

TEST(Lens, RefusesOtherNumbersOfCoefficients) {
  const auto code = [](LensModel model, std::vector<double> distortion) {
    return testing::code_of([&] { Lens(300.0, kPrincipal, model, distortion); });
  };
  for (const std::size_t n : {0U, 4U, 5U, 8U}) {
    EXPECT_EQ(code(LensModel::kPerspective, std::vector<double>(n, 0.001)), "no error") << n;
  }
  for (const std::size_t n : {1U, 6U, 7U}) {
    EXPECT_EQ(code(LensModel::kPerspective, std::vector<double>(n, 0.001)), "frame-camera") << n;
  }
  EXPECT_EQ(code(LensModel::kFisheye, {}), "frame-camera");
  EXPECT_EQ(code(LensModel::kFisheye, std::vector<double>(5, 0.001)), "frame-camera");
  EXPECT_EQ(code(LensModel::kPerspective, {NAN, 0, 0, 0}), "frame-camera");
}

}  // namespace
}  // namespace roadfix
