#include "server/api/feature_request.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "core/detect/frame_camera.hpp"
#include "core/detect/image_codec.hpp"

namespace roadfix::api {
namespace {

class NoRoads : public RoadDetector {
 public:
  CellArray detect(const GroundImage&, double, std::uint64_t, const std::stop_token&) const override {
    return {4, 4, kNoRoad};
  }
  double preferred_gsd_m() const override { return 1.0; }
  double halo_m() const override { return 0.0; }
  std::string describe() const override { return "none"; }
};

double nadir_sigma_m_of(const nlohmann::json& request) {
  Content content;
  content.fields.add(request, feature_fields());
  content.image = encode_feature_map(CellArray(20, 20, kNoRoad));
  return features_of(content, NoRoads(), 2.0, Limits{}, {}).map.nadir_sigma_m;
}

TEST(FeatureRequest, ExpectsAnErrorOfADegreeOfAnAttitudeThatIsTold) {
  const double degree_m = 40 * std::numbers::pi / 180.0;
  EXPECT_NEAR(nadir_sigma_m_of({{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}, {"roll_deg", 0}}), degree_m, 1e-9);
  EXPECT_NEAR(nadir_sigma_m_of({{"kind", "frame"}, {"focal_px", 30}, {"agl_m", 40}, {"pitch_deg", 45}}), 2 * degree_m,
              1e-9);
}

TEST(FeatureRequest, ExpectsThatACameraThatSaysNothingOfItsAttitudeMayLean) {
  EXPECT_NEAR(nadir_sigma_m_of({{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}}),
              40 * kUntoldAttitudeSigma.radians(), 1e-9);
}

TEST(FeatureRequest, TakesThePlaceOfTheNadirInOtherPicturesForExact) {
  EXPECT_EQ(nadir_sigma_m_of({{"cell_m", 2}}), 0.0);
  EXPECT_EQ(nadir_sigma_m_of({{"kind", "frame"}, {"gsd_m", 0.5}}), 0.0);
}

TEST(FeatureRequest, TakesWhatItIsToldOfTheNadir) {
  EXPECT_EQ(nadir_sigma_m_of({{"cell_m", 2}, {"nadir_sigma_m", 12}}), 12.0);
  EXPECT_EQ(nadir_sigma_m_of({{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}, {"nadir_sigma_m", 0}}), 0.0);
}

}  // namespace
}  // namespace roadfix::api
