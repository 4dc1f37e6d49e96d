// What an autopilot is told: where the vehicle was, and when. Free of any protocol.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "core/geodesy/latlon.hpp"
#include "core/units/angle.hpp"

namespace roadfix::autopilot {

struct Position {
  LatLon at;
  std::optional<Angle> heading;   ///< of the vehicle, clockwise from true north; nullopt = not known well enough
  std::optional<double> sigma_m;  ///< 1 sigma along the longer axis of the ellipse, so that no axis is thought better
};

struct PositionReport {
  std::optional<Position> position;         ///< nothing stands for "not known", never for a guess
  std::optional<double> altitude_msl_m;     ///< as the client knows it: a map of roads tells none
  std::int64_t captured_us = 0;             ///< of the frame, since 1970 or since the vehicle's start
  std::chrono::microseconds processing{0};  ///< from the frame to this message
};

}  // namespace roadfix::autopilot
