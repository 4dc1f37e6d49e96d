// One question with its truth, and one method's answer to it.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/detect/frame.hpp"
#include "core/detect/orthoimage.hpp"
#include "core/grid/combine.hpp"
#include "core/locate/altitude.hpp"
#include "core/locate/fix.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix::bench {

/// What a frame shows, shared by all queries that it is part of.
using SharedView = std::shared_ptr<const GroundView>;

/// A frame taken before the one that is asked about, and where.
struct EarlierFrame {
  SharedView view;
  BodyOffset offset;
  std::optional<Altitude> altitude;  ///< as Query::altitude
};

struct Query {
  std::string id;                      ///< "adiyaman/0007" or the frame's file
  SharedView view;                     ///< what the frame shows; nullptr where there is none
  std::optional<FeatureMap> features;  ///< instead of a view where the query is simulated
  std::optional<Altitude> altitude;    ///< from which `view` was taken, where that is told
  std::optional<GeoPose> truth;        ///< nullopt = the ground is not on the map
  Prior prior;
  double scale_range = 0.0;           ///< SearchOptions::scale_range
  std::vector<EarlierFrame> earlier;  ///< to be laid together with `view`
  std::string unasked;                ///< code of why it is not asked but counts as not found; empty = it is
};

/// The only one, or combined().
FeatureMap as_one(std::span<const PlacedFeatures> frames);

/// What the frames of the query, its own first, show together if the vehicle is there: as levelled_frames(), or as they
/// are where the query tells no altitude or the map has no heights.
FeatureMap seen_from(const GeoPose& place, const Query& query, std::span<const PlacedFeatures> frames,
                     const MapView& map);

/// Keypoints of a frame matched with the imagery of the map, and those of them at the right place: the paper's
/// figure 1.
struct KeypointCounts {
  int matches = 0;
  int right = 0;  ///< see kRightMatchM
};

struct Answer {
  FixStatus status = FixStatus::kNoFix;
  std::string reason;
  std::optional<GeoPose> best;  ///< best guess, also where the status is not `fix`
  std::optional<FixMode> mode;  ///< the same with its ellipse, from methods that give one
  std::optional<SearchFigures> figures;
  double probability = 0.0;
  // What the frame tells that it may be off by itself: a part of what the mode states that no calibration scales.
  double nadir_sigma_m = 0.0;
  Angle nadir_heading_sigma{};
  std::vector<std::size_t> left_out;  ///< FramesTogether::left_out
  double time_ms = 0.0;               ///< 0 where no place was looked for: not counted
  // Of the true place, where it is known; the time does not count.
  std::optional<KeypointCounts> keypoints;  ///< of keypoint methods
  std::optional<double> rho_at_truth;       ///< equation (5) of the roads there: the paper's figure 2
};

/// What a method knows at the start; `answer` may be called from several threads.
class Method {
 public:
  virtual ~Method() = default;
  virtual Answer answer(const Query& query) const = 0;
  /// What led to the answer, beside the truth, for the eye (CV_8UC3); empty where there is nothing to see. `imagery` is
  /// that of the map and may be empty. May be called from several threads.
  virtual cv::Mat drawn(const Query& query, const Answer& answer, std::span<const Orthoimage> imagery) const = 0;
};

}  // namespace roadfix::bench
