// The detectors of frames: the network that read a map's imagery reads the frames that are compared with it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/detect/make_detector.hpp"

namespace roadfix {

/// Whether the choice makes one detector for all that frames are compared with.
bool is_one_for_both(const DetectorChoice& choice);

/// What Detectors::for_map() gives, without loading a network that is not asked. Throws what make_detector() does.
std::shared_ptr<const RoadDetector> detector_for_map(const DetectorChoice& choice,
                                                     const std::optional<std::string>& imagery_reader);

/// Whether the detector for frames over a map is the one that read its imagery, if it has any.
bool is_reader_of(const RoadDetector& detector, const std::optional<std::string>& imagery_reader);

class Detectors {
 public:
  /// Throws what make_detector() does.
  explicit Detectors(const DetectorChoice& choice);
  /// One for all maps.
  explicit Detectors(std::shared_ptr<const RoadDetector> detector);

  std::shared_ptr<const RoadDetector> compared_with(SourceContent compared) const;

  /// `imagery_reader` is MapView::imagery_reader. A map that is read by a detector that is not among these gets the one
  /// for imagery.
  std::shared_ptr<const RoadDetector> for_map(const std::optional<std::string>& imagery_reader) const;

  /// Whether one of them read the map's imagery, if it has any.
  bool include_reader(const std::optional<std::string>& imagery_reader) const;

  /// One line that names them.
  std::string describe() const;

 private:
  std::shared_ptr<const RoadDetector> for_imagery_;
  std::shared_ptr<const RoadDetector> for_roads_;
};

}  // namespace roadfix
