#include "cli/fly/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "cli/fly/vehicle.hpp"
#include "core/detect/frame.hpp"

namespace roadfix::fly {
namespace {

// So much more ground than a frame of level ground would show is looked at, where that is not level.
constexpr double kMargin = 1.4;

/// As shown_in_relief().
GroundImage in_relief(const GroundImage& ground, const Relief& relief, const cv::Size& size) {
  cv::Mat_<cv::Vec2f> source(size);
  for (int row = 0; row < size.height; ++row) {
    for (int col = 0; col < size.width; ++col) {
      const double right = col + 0.5 - 0.5 * size.width;
      const double back = row + 0.5 - 0.5 * size.height;
      const double stretch = relief.stretch_at(ground.gsd_m * right, ground.gsd_m * back);
      source(row, col) = {static_cast<float>(0.5 * ground.pixels.cols + right / stretch - 0.5),
                          static_cast<float>(0.5 * ground.pixels.rows + back / stretch - 0.5)};
    }
  }
  GroundImage shown = ground;
  cv::remap(ground.pixels, shown.pixels, source, cv::noArray(), cv::INTER_LINEAR);
  cv::remap(ground.observed, shown.observed, source, cv::noArray(), cv::INTER_NEAREST);
  return shown;
}

/// Cuts frames out of imagery.
class Camera {
 public:
  Camera(const Orthoimage& imagery, const Footprint& footprint, const CameraErrors& errors, double cell_m)
      : imagery_(imagery), footprint_(footprint), errors_(errors), cell_m_(cell_m) {}

  /// Where a frame is taken and how wrong, drawn before it is cut out.
  Outlook aim(const Outlook& from, evaluation::Random& random) const {
    // A small tilt moves what is seen; that it also stretches it by a share of that is left out.
    const double forward = errors_.agl_m * std::tan(errors_.attitude.radians() * normal(random));
    const double right = errors_.agl_m * std::tan(errors_.attitude.radians() * normal(random));
    const double now = std::max(0.5, 1.0 + errors_.altitude * normal(random));
    return {moved(from.pose, {forward, right, {}}), from.scale * now, from.relief};
  }

  GroundImage take(const Outlook& from) const {
    const double gsd_m = imagery_.image.gsd_m;
    const double margin = from.relief ? kMargin : 1.0;
    const double covered = margin * from.scale;
    GroundImage frame =
        cut_out(imagery_, from.pose, {covered * footprint_.width_m, covered * footprint_.height_m}, from.scale * gsd_m);
    if (from.relief) {
      const auto pixels = [&](double metres) { return static_cast<int>(std::lround(metres / gsd_m)); };
      frame = in_relief(frame, *from.relief, {pixels(footprint_.width_m), pixels(footprint_.height_m)});
    }
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

  Observation observe(const Outlook& from, evaluation::Random& random) const override {
    const GroundImage frame = camera_.take(camera_.aim(from, random));
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

  Observation observe(const Outlook& from, evaluation::Random& random) const override {
    return {std::nullopt, [camera = camera_, shot = camera_.aim(from, random)] {
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

  Observation observe(const Outlook& from, evaluation::Random& random) const override {
    const auto cells = [&](double metres) {
      return std::max(1, static_cast<int>(std::lround(from.scale * metres / ground_.geometry.cell_m)));
    };
    const double margin = from.relief ? kMargin : 1.0;
    FeatureMap features = simulate_features(ground_, from.pose, cells(margin * footprint_.width_m),
                                            cells(margin * footprint_.height_m), quality_, random);
    if (from.relief) {
      features = shown_in_relief(features, *from.relief, cells(footprint_.width_m), cells(footprint_.height_m));
    }
    features.cell_m /= from.scale;
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
