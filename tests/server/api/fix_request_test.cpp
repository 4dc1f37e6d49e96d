#include "server/api/fix_request.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "server/api/feature_request.hpp"

namespace roadfix::api {
namespace {

double nadir_sigma_m_of(const nlohmann::json& request) {
  Fields fields;
  fields.add(request, joined(prior_fields(), feature_fields()));
  return parse_fix_options(fields, Limits{}).nadir_sigma_m;
}

TEST(FixRequest, ExpectsAnErrorOfADegreeOfACameraThatSaysNothingOfItsAttitude) {
  const double degree = std::numbers::pi / 180.0;
  EXPECT_NEAR(nadir_sigma_m_of({{"kind", "frame"}, {"fov_deg", 80}, {"agl_m", 400}}), 400 * degree, 1e-9);
  EXPECT_NEAR(nadir_sigma_m_of({{"kind", "frame"}, {"focal_px", 900}, {"agl_m", 400}, {"pitch_deg", 45}}),
              2 * 400 * degree, 1e-9);
}

TEST(FixRequest, TakesThePlaceOfTheNadirInOtherPicturesForExact) {
  EXPECT_EQ(nadir_sigma_m_of({{"cell_m", 2}}), 0.0);
  EXPECT_EQ(nadir_sigma_m_of({{"kind", "frame"}, {"gsd_m", 0.5}}), 0.0);
}

TEST(FixRequest, TakesWhatItIsToldOfTheNadir) {
  EXPECT_EQ(nadir_sigma_m_of({{"cell_m", 2}, {"nadir_sigma_m", 12}}), 12.0);
  EXPECT_EQ(nadir_sigma_m_of({{"kind", "frame"}, {"fov_deg", 80}, {"agl_m", 400}, {"nadir_sigma_m", 0}}), 0.0);
}

}  // namespace
}  // namespace roadfix::api
