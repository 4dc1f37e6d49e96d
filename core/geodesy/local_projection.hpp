// The projection of a UTM zone over some kilometres as polynomials: what projects the thousands of poses of a match for
// a tenth of the time.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <utility>

#include "core/geodesy/utm.hpp"

namespace roadfix {

struct ProjectedPoint {
  GridPoint point;
  Angle convergence;  ///< see UtmZone::convergence()
};

/// By Chebyshev polynomials of degree 4 in latitude and longitude over a box. Wherever UTM is defined, up to 84 degrees
/// of latitude and 9 degrees off the central meridian, it differs from UtmZone by less than kMaxErrorM and kMaxTurn.
class LocalProjection {
 public:
  static constexpr double kSideDeg = 0.25;
  static constexpr double kMaxErrorM = 1e-6;
  static constexpr Angle kMaxTurn = Angle::radians(1e-12);

  /// Over the box of kSideDeg north and east of `south_west`; nullopt where UTM is undefined in parts of it.
  static std::optional<LocalProjection> over(const UtmZone& zone, LatLon south_west);

  /// `point` lies in the box.
  ProjectedPoint at(LatLon point) const;

 private:
  static constexpr std::size_t kTerms = 5;
  using Terms = std::array<std::array<double, kTerms>, kTerms>;  ///< [latitude][longitude]

  explicit LocalProjection(LatLon south_west) : south_west_(south_west) {}

  LatLon south_west_;
  Terms east_{}, north_{}, convergence_{};
};

/// Projects many points, those of a box in which there are many of them by a LocalProjection.
class PointProjector {
 public:
  explicit PointProjector(const UtmZone& zone) : zone_(zone) {}
  PointProjector(const PointProjector&) = delete;
  PointProjector& operator=(const PointProjector&) = delete;
  /// nullopt where UTM is undefined. Throws InvalidInput for NaN and out-of-range values.
  std::optional<ProjectedPoint> operator()(LatLon point);

 private:
  using BoxIndex = std::pair<int, int>;
  struct Box {
    int asked = 0;
    std::optional<LocalProjection> local;
  };

  Box& box_of(BoxIndex index);

  UtmZone zone_;
  std::map<BoxIndex, Box> boxes_;
  std::map<BoxIndex, Box>::iterator last_ = boxes_.end();  ///< asked for: the next point is mostly there too
};

}  // namespace roadfix
