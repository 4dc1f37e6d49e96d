// What the vehicle sees of the ground below it, in the body frame: a feature map, or the picture of which another side
// makes one.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "cli/evaluation/random.hpp"
#include "core/detect/frame_camera.hpp"
#include "core/detect/frame_image.hpp"
#include "core/detect/orthoimage.hpp"
#include "core/detect/road_detector.hpp"
#include "core/grid/feature_map.hpp"
#include "core/grid/relief.hpp"
#include "core/locate/map_view.hpp"
#include "core/survey/simulate.hpp"

namespace roadfix::fly {

/// Of detectors that use random numbers: that of a service, so that both find the same roads.
inline constexpr std::uint64_t kDetectorSeed = 1;

/// A picture of the ground, before its roads are detected.
struct CameraFrame {
  FramePixels picture;
  FrameView view;
  double cell_m = 0.0;  ///< of the feature map that is to be made of it
};

/// Called when the picture is needed: those of whole flights would fill the memory. Equal calls give equal pictures.
using FrameSource = std::function<CameraFrame()>;

/// One of the two.
struct Observation {
  std::optional<FeatureMap> features;
  FrameSource frame;
};

/// From where the ground is looked at.
struct Outlook {
  GridPose pose;
  double scale = 1.0;                 ///< the ground is so many times as large as the observation will say
  std::optional<Relief> relief = {};  ///< nullopt = it is level
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Safe to call from several threads with generators of their own.
  virtual Observation observe(const Outlook& from, evaluation::Random& random) const = 0;
  /// Whether the middle of the frame would show ground.
  virtual bool shows(GridPoint point) const = 0;
};

/// How wrong the frame's rectification is, 1 sigma in every frame.
struct CameraErrors {
  Angle attitude = Angle::degrees(1.0);  ///< roll and pitch that were not known
  double altitude = 0.02;                ///< relative
  double agl_m = 300.0;                  ///< by which attitude becomes a shift on the ground
};

/// Frames cut out of imagery and given to the detector. Both must outlive the sensor.
std::unique_ptr<Sensor> make_imaging_sensor(const Orthoimage& imagery, const RoadDetector& detector,
                                            const Footprint& footprint, const CameraErrors& errors, double cell_m);

/// The same frames, for a detector elsewhere. The imagery must outlive the flights too.
std::unique_ptr<Sensor> make_camera(const Orthoimage& imagery, const Footprint& footprint, const CameraErrors& errors,
                                    double cell_m);

/// Feature maps of stated quality cut out of the map itself.
std::unique_ptr<Sensor> make_simulated_sensor(const MapView& map, const Footprint& footprint,
                                              const FeatureQuality& quality);

}  // namespace roadfix::fly
