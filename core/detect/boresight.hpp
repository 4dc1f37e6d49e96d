// Boresight: how a camera is turned against the attitude that is told of it, from a flight whose places were known and
// whose frames were found on the map.
//
// A camera that looks farther ahead than is told moves what it shows, and with it the place that is found, ahead by the
// height times the angle. One that is turned about its optical axis turns the heading. A map or a GPS that is off moves
// all places alike, whatever the heading, and a picture that was taken before its time moves them against the flight.
// All of these are estimated together (least squares without the frames that lie elsewhere), each with its error, so
// that what a flight does not tell apart is seen to be unknown.
#pragma once

#include <algorithm>
#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/detect/attitude.hpp"
#include "core/detect/frame_camera.hpp"
#include "core/units/planar.hpp"

namespace roadfix {

/// A frame whose place was known, and that was found.
struct BoresightSighting {
  FrameCamera camera;  ///< as told; roll and pitch that are not told count as zero
  cv::Size frame;      ///< pixels
  GridPose told;       ///< of the UAV; the heading is that of the frame's upper edge
  GridPose found;
  double size = 1.0;                        ///< found, of the ground as told
  std::optional<GridPoint> velocity_m_s{};  ///< over ground, east and north
};

/// What is known beforehand, 1 sigma.
struct BoresightPrior {
  double place_sigma_m = 3.0;  ///< of the map and of the told places of a flight as a whole, per axis
  double delay_sigma_s = 0.2;  ///< of when pictures were taken
};

/// 1 sigma beside each value.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;
};

struct Boresight {
  /// Mount of the camera in the axes of what is told: how much farther to the right its upper edge points, how much
  /// farther ahead it looks, and how much farther down its right side is.
  Estimate yaw_deg, pitch_deg, roll_deg;
  Estimate size;                    ///< of the ground, as a factor to what is told: of heights, or 1 / focal length
  std::optional<Estimate> delay_s;  ///< pictures were taken so much before their time; nullopt where nothing moved
  Estimate east_m, north_m;         ///< of the map against the told places
  bool is_roll_reversed = false;    ///< what is told has the wrong sign; the mount is beside what is right
  bool is_pitch_reversed = false;
  /// How well roll and pitch are known once all of this is told, 1 sigma each: FrameCamera::attitude_sigma. What the
  /// mount is uncertain by counts, and what else the places scatter by.
  Angle attitude_sigma;
  std::vector<bool> used;        ///< by sighting: it does not lie elsewhere
  double told_rms_m = 0.0;       ///< how far the used sightings are found from where they are told
  double corrected_rms_m = 0.0;  ///< and once all of the above is taken into account

  std::size_t used_count() const { return static_cast<std::size_t>(std::ranges::count(used, true)); }
  Attitude mount() const {
    return {Angle::degrees(yaw_deg.value), Angle::degrees(pitch_deg.value), Angle::degrees(roll_deg.value)};
  }
};

/// Fewer sightings tell nothing: there are three angles, and the place of the map.
inline constexpr std::size_t kFewestSightings = 6;

/// There are at least kFewestSightings, whose cameras are validated.
Boresight boresight_of(std::span<const BoresightSighting> sightings, const BoresightPrior& prior);

}  // namespace roadfix
