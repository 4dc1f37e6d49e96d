#include "core/detect/detectors.hpp"

#include <fmt/format.h>

#include <functional>
#include <utility>

namespace roadfix {
namespace {

/// The network for imagery is asked first: it reads most maps that are not of roads alone.
std::shared_ptr<const RoadDetector> chosen_for(
    const std::optional<std::string>& imagery_reader,
    const std::function<std::shared_ptr<const RoadDetector>(SourceContent)>& detector) {
  if (!imagery_reader) return detector(SourceContent::kRoads);
  auto for_imagery = detector(SourceContent::kImagery);
  if (is_reader_of(*for_imagery, imagery_reader)) return for_imagery;
  auto for_roads = detector(SourceContent::kRoads);
  return is_reader_of(*for_roads, imagery_reader) ? for_roads : for_imagery;
}

}  // namespace

bool is_one_for_both(const DetectorChoice& choice) {
  return !is_left_to_default(choice) || default_model(SourceContent::kImagery) == default_model(SourceContent::kRoads);
}

bool is_reader_of(const RoadDetector& detector, const std::optional<std::string>& imagery_reader) {
  return !imagery_reader || is_same_reader(*imagery_reader, detector.describe());
}

std::shared_ptr<const RoadDetector> detector_for_map(const DetectorChoice& choice,
                                                     const std::optional<std::string>& imagery_reader) {
  if (is_one_for_both(choice)) return make_detector(choice, SourceContent::kImagery);
  return chosen_for(imagery_reader, [&](SourceContent compared) { return make_detector(choice, compared); });
}

Detectors::Detectors(const DetectorChoice& choice)
    : for_imagery_(make_detector(choice, SourceContent::kImagery)), for_roads_(for_imagery_) {
  if (!is_one_for_both(choice)) for_roads_ = make_detector(choice, SourceContent::kRoads);
}

Detectors::Detectors(std::shared_ptr<const RoadDetector> detector)
    : for_imagery_(detector), for_roads_(std::move(detector)) {}

std::shared_ptr<const RoadDetector> Detectors::compared_with(SourceContent compared) const {
  return compared == SourceContent::kImagery ? for_imagery_ : for_roads_;
}

std::shared_ptr<const RoadDetector> Detectors::for_map(const std::optional<std::string>& imagery_reader) const {
  return chosen_for(imagery_reader, [&](SourceContent compared) { return compared_with(compared); });
}

bool Detectors::include_reader(const std::optional<std::string>& imagery_reader) const {
  return is_reader_of(*for_map(imagery_reader), imagery_reader);
}

std::string Detectors::describe() const {
  const std::string imagery = for_imagery_->describe();
  const std::string roads = for_roads_->describe();
  return imagery == roads ? imagery : fmt::format("{}; over road data {}", imagery, roads);
}

}  // namespace roadfix
