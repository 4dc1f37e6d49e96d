// What can be wrong with simulated feature maps, by name.
#pragma once

#include <array>
#include <string_view>

#include "core/survey/simulate.hpp"

namespace roadfix::bench {

struct QualityProperty {
  std::string_view key;  ///< in manifests
  double FeatureQuality::*value;
  double max;              ///< the most that a manifest may ask for
  std::string_view words;  ///< what stands behind its value, which is in percent before "%"
  std::string_view curve;  ///< the file of its picture, without ".svg"
  std::string_view axis;   ///< of that picture
};

/// All of them. Queries draw them in this order, so that another one would change what seeds give.
inline constexpr std::array<QualityProperty, 6> kQualityProperties{
    {{"erase", &FeatureQuality::erase, 1.0, "% erased", "erased", "share of the road cells erased"},
     {"invent", &FeatureQuality::invent, 10.0, "% invented", "invented",
      "invented road cells, as a share of the true ones"},
     {"block", &FeatureQuality::block, 0.9, "% blocked", "blocked", "share of the footprint not observed"},
     {"shift_m", &FeatureQuality::shift_m, 1000.0, "m shifted", "shifted",
      "shift of map against ground, m (1 sigma per axis)"},
     {"scale", &FeatureQuality::scale, 0.2, "% scaled", "scaled", "relative error of the scale (1 sigma)"},
     {"tilt_deg", &FeatureQuality::tilt_deg, 20.0, "deg tilted", "tilted", "tilt, degrees (1 sigma per axis)"}}};
static_assert(sizeof(FeatureQuality) == kQualityProperties.size() * sizeof(double), "a property is not in the table");

}  // namespace roadfix::bench
