// An angle that knows its unit: built from degrees() or radians(), never from a bare double.
#pragma once

#include <compare>
#include <numbers>

namespace roadfix {

class Angle {
 public:
  constexpr Angle() = default;
  static constexpr Angle radians(double value) { return Angle(value); }
  static constexpr Angle degrees(double value) { return Angle(value * std::numbers::pi / 180.0); }

  constexpr double radians() const { return radians_; }
  constexpr double degrees() const { return radians_ * 180.0 / std::numbers::pi; }

  /// The same direction in (-pi, pi].
  Angle wrapped() const;
  /// The same direction as degrees in [0, 360), the range of headings at the API.
  double compass_degrees() const;

  constexpr Angle operator-() const { return Angle(-radians_); }
  constexpr Angle& operator+=(Angle other) {
    radians_ += other.radians_;
    return *this;
  }
  friend constexpr Angle operator+(Angle a, Angle b) { return Angle(a.radians_ + b.radians_); }
  friend constexpr Angle operator-(Angle a, Angle b) { return Angle(a.radians_ - b.radians_); }
  friend constexpr Angle operator*(double factor, Angle a) { return Angle(factor * a.radians_); }
  friend constexpr auto operator<=>(Angle, Angle) = default;

 private:
  explicit constexpr Angle(double radians) : radians_(radians) {}
  double radians_ = 0.0;
};

/// Smallest rotation between two directions, in [0, pi].
Angle angular_distance(Angle a, Angle b);

double sin(Angle angle);
double cos(Angle angle);

}  // namespace roadfix
