#include "core/detect/detectors.hpp"

#include <fmt/format.h>

#include <functional>
#include <utility>

namespace roadfix {
namespace {

/// The network for imagery is asked first: it reads most maps that are not of roads alone.
std::shared_ptr<const RoadDetector> chosen_for(
    std::string_view imagery_reader, const std::function<std::shared_ptr<const RoadDetector>(ComparedWith)>& detector) {
  if (imagery_reader.empty()) return detector(ComparedWith::kRoads);
  auto for_imagery = detector(ComparedWith::kImagery);
  if (is_reader_of(*for_imagery, imagery_reader)) return for_imagery;
  auto for_roads = detector(ComparedWith::kRoads);
  return is_reader_of(*for_roads, imagery_reader) ? for_roads : for_imagery;
}

}  // namespace

bool is_one_for_both(const DetectorChoice& choice) {
  return !is_left_to_default(choice) || default_model(ComparedWith::kImagery) == default_model(ComparedWith::kRoads);
}

bool is_reader_of(const RoadDetector& detector, std::string_view imagery_reader) {
  return imagery_reader.empty() || is_same_reader(imagery_reader, detector.describe());
}

std::shared_ptr<const RoadDetector> detector_for_map(const DetectorChoice& choice, std::string_view imagery_reader) {
  if (is_one_for_both(choice)) return make_detector(choice, ComparedWith::kImagery);
  return chosen_for(imagery_reader, [&](ComparedWith compared) { return make_detector(choice, compared); });
}

Detectors::Detectors(const DetectorChoice& choice)
    : for_imagery_(make_detector(choice, ComparedWith::kImagery)), for_roads_(for_imagery_) {
  if (!is_one_for_both(choice)) for_roads_ = make_detector(choice, ComparedWith::kRoads);
}

Detectors::Detectors(std::shared_ptr<const RoadDetector> detector)
    : for_imagery_(detector), for_roads_(std::move(detector)) {}

std::shared_ptr<const RoadDetector> Detectors::compared_with(ComparedWith compared) const {
  return compared == ComparedWith::kImagery ? for_imagery_ : for_roads_;
}

std::shared_ptr<const RoadDetector> Detectors::for_map(std::string_view imagery_reader) const {
  return chosen_for(imagery_reader, [&](ComparedWith compared) { return compared_with(compared); });
}

bool Detectors::include_reader(std::string_view imagery_reader) const {
  return is_reader_of(*for_map(imagery_reader), imagery_reader);
}

std::string Detectors::describe() const {
  const std::string imagery = for_imagery_->describe();
  const std::string roads = for_roads_->describe();
  return imagery == roads ? imagery : fmt::format("{}; over road data {}", imagery, roads);
}

}  // namespace roadfix
