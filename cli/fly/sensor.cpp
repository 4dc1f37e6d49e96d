#include "cli/fly/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/fly/vehicle.hpp"
#include "core/detect/frame.hpp"

namespace roadfix::fly {
namespace {

/// Where a frame is taken and how wrong, drawn before it is cut out.
struct Shot {
  GridPose pose;
  double scale = 1.0;
};

/// Cuts frames out of imagery.
class Camera {
 public:
  Camera(const Orthoimage& imagery, const Footprint& footprint, const CameraErrors& errors, double cell_m)
      : imagery_(imagery), footprint_(footprint), errors_(errors), cell_m_(cell_m) {}

  Shot aim(const GridPose& pose, double scale, evaluation::Random& random) const {
    // A small tilt moves what is seen; that it also stretches it by a share of that is left out.
    const double forward = errors_.agl_m * std::tan(errors_.attitude.radians() * normal(random));
    const double right = errors_.agl_m * std::tan(errors_.attitude.radians() * normal(random));
    const double now = std::max(0.5, 1.0 + errors_.altitude * normal(random));
    return {moved(pose, {forward, right, {}}), scale * now};
  }

  GroundImage take(const Shot& shot) const {
    const double gsd_m = imagery_.image.gsd_m;
    const Footprint covered{shot.scale * footprint_.width_m, shot.scale * footprint_.height_m};
    GroundImage frame = cut_out(imagery_, shot.pose, covered, shot.scale * gsd_m);
    frame.gsd_m = gsd_m;
    return frame;
  }

  double cell_m() const { return cell_m_; }

  bool shows(GridPoint point) const { return sees(imagery_, point); }

 private:
  const Orthoimage& imagery_;
  Footprint footprint_;
  CameraErrors errors_;
  double cell_m_;
};

class ImagingSensor : public Sensor {
 public:
  ImagingSensor(const Camera& camera, const RoadDetector& detector) : camera_(camera), detector_(detector) {}

  Observation observe(const GridPose& pose, double scale, evaluation::Random& random) const override {
    const GroundImage frame = camera_.take(camera_.aim(pose, scale, random));
    return {detect_features(detector_, vertical_view(frame), camera_.cell_m(), kDetectorSeed), {}};
  }

  bool shows(GridPoint point) const override { return camera_.shows(point); }

 private:
  Camera camera_;
  const RoadDetector& detector_;
};

class CameraSensor : public Sensor {
 public:
  explicit CameraSensor(const Camera& camera) : camera_(camera) {}

  Observation observe(const GridPose& pose, double scale, evaluation::Random& random) const override {
    return {std::nullopt, [camera = camera_, shot = camera_.aim(pose, scale, random)] {
              GroundImage image = camera.take(shot);
              return CameraFrame{
                  {std::move(image.pixels), std::move(image.observed)}, StraightDown{image.gsd_m}, camera.cell_m()};
            }};
  }

  bool shows(GridPoint point) const override { return camera_.shows(point); }

 private:
  Camera camera_;
};

class SimulatedSensor : public Sensor {
 public:
  SimulatedSensor(const MapView& map, const Footprint& footprint, const FeatureQuality& quality)
      : ground_(map.read(GridGeometry::covering(map.extent, map.cell_m))), footprint_(footprint), quality_(quality) {}

  Observation observe(const GridPose& pose, double scale, evaluation::Random& random) const override {
    const double cell_m = ground_.geometry.cell_m;
    const auto cells = [&](double metres) { return static_cast<int>(std::lround(scale * metres / cell_m)); };
    FeatureMap features =
        simulate_features(ground_, pose, cells(footprint_.width_m), cells(footprint_.height_m), quality_, random);
    features.cell_m /= scale;
    return {std::move(features), {}};
  }

  bool shows(GridPoint point) const override { return is_observed(ground_.cell_at(point)); }

 private:
  RoadGrid ground_;
  Footprint footprint_;
  FeatureQuality quality_;
};

}  // namespace

std::unique_ptr<Sensor> make_imaging_sensor(const Orthoimage& imagery, const RoadDetector& detector,
                                            const Footprint& footprint, const CameraErrors& errors, double cell_m) {
  return std::make_unique<ImagingSensor>(Camera(imagery, footprint, errors, cell_m), detector);
}

std::unique_ptr<Sensor> make_camera(const Orthoimage& imagery, const Footprint& footprint, const CameraErrors& errors,
                                    double cell_m) {
  return std::make_unique<CameraSensor>(Camera(imagery, footprint, errors, cell_m));
}

std::unique_ptr<Sensor> make_simulated_sensor(const MapView& map, const Footprint& footprint,
                                              const FeatureQuality& quality) {
  return std::make_unique<SimulatedSensor>(map, footprint, quality);
}

}  // namespace roadfix::fly
