#include "cli/bench/roads_method.hpp"

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "cli/bench/agreement_picture.hpp"
#include "cli/limits.hpp"
#include "core/detect/frame.hpp"
#include "core/grid/combine.hpp"
#include "core/grid/resample.hpp"
#include "core/locate/levelled_fix.hpp"
#include "core/locate/match_poses.hpp"
#include "core/locate/told_frames.hpp"
#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

constexpr const char* kRepeated = "frames-repeated";

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Detected {
  FeatureMap features;
  double time_ms = 0.0;
};

/// By view, for as long as a query has it.
class DetectedViews {
 public:
  std::optional<Detected> find(const SharedView& view) {
    const std::lock_guard lock(mutex_);
    const auto found = detected_.find(view);
    return found == detected_.end() ? std::nullopt : std::optional(found->second);
  }

  void insert(const SharedView& view, const Detected& detected) {
    const std::lock_guard lock(mutex_);
    std::erase_if(detected_, [](const auto& kept) { return kept.first.expired(); });
    detected_.emplace(view, detected);
  }

 private:
  std::mutex mutex_;
  std::map<std::weak_ptr<const GroundView>, Detected, std::owner_less<>> detected_;
};

/// What a query shows: of its own frame first.
struct Parts {
  std::vector<PlacedFeatures> features;
  double detection_ms = 0.0;
};

/// As if it had been made for the altitude of the query, raised by how much higher the frame was taken.
PlacedFeatures placed_in(const Query& query, const EarlierFrame& frame, const FeatureMap& features) {
  if (!query.altitude || !frame.altitude) return {features, frame.offset};
  const Altitude& of_query = *query.altitude;
  const Altitude& own = *frame.altitude;
  if (!of_query.above_sea_m) return {features, frame.offset, own.agl_m - of_query.agl_m};
  const double higher_m = own.above_sea_m.value() - *of_query.above_sea_m;
  const FeatureMap sized = seen_from(features, own, of_query.agl_m + higher_m);
  return {resampled(sized, features.cell_m), frame.offset, higher_m};
}

class RoadsMethod : public Method {
 public:
  RoadsMethod(const MapView& map, std::shared_ptr<const RoadDetector> detector, const RoadsOptions& options)
      : map_(map), detector_(std::move(detector)), options_(options) {}

  Answer answer(const Query& query) const override {
    const Parts parts = parts_of(query);
    const auto start = Clock::now();
    const std::optional<FramesTogether> seen = together(parts.features);
    Answer answer;
    if (!seen) {
      answer.reason = kRepeated;
      return answer;
    }
    FixOptions options = options_.fix;
    options.search.scale_range = query.scale_range;
    if (parts.features.size() > 1) {
      options.own_frame = parts.features.front().features;
      options.others.assign(std::next(parts.features.begin()), parts.features.end());
    }
    options.left_out = seen->left_out;
    const Fix fix = locate_levelled(query.altitude, map_, seen->features, query.prior, options);
    answer.status = fix.status;
    answer.reason = fix.reason;
    answer.probability = fix.probability;
    answer.figures = fix.figures;
    if (!fix.modes.empty()) {
      answer.mode = fix.modes.front();
      answer.best = answer.mode->pose;
      answer.nadir_sigma_m = answer.mode->scale * seen->features.nadir_sigma_m;
      answer.nadir_heading_sigma = seen->features.nadir_heading_sigma;
    }
    answer.left_out = seen->left_out;
    answer.time_ms = parts.detection_ms + ms_since(start);
    if (query.truth) {
      const FeatureMap there = seen_from(*query.truth, query, parts.features, map_);
      answer.rho_at_truth = match(map_, there, std::span(&*query.truth, 1)).front().rho;
    }
    return answer;
  }

  cv::Mat drawn(const Query& query, const Answer& answer, std::span<const Orthoimage> imagery) const override {
    return agreement_picture(map_, imagery, query, parts_of(query).features, answer);
  }

 private:
  /// Once for all queries that show it, unless two ask for it at the same moment.
  Detected detected(const SharedView& view) const {
    if (const auto kept = detected_.find(view)) return *kept;
    const auto start = Clock::now();
    const FeatureMap features = detect_features(*detector_, *view, options_.cell_m, options_.seed);
    Detected fresh{features, ms_since(start)};
    detected_.insert(view, fresh);
    return fresh;
  }

  Parts parts_of(const Query& query) const {
    if (query.features) return {{{*query.features, {}}}};
    Parts parts;
    const auto detected_in = [&](const SharedView& view) {
      const Detected part = detected(view);
      parts.detection_ms += part.time_ms;
      return part.features;
    };
    parts.features.push_back({detected_in(query.view), {}});
    for (const EarlierFrame& frame : query.earlier) {
      parts.features.push_back(placed_in(query, frame, detected_in(frame.view)));
    }
    return parts;
  }

  /// As `fix` takes several frames; nullopt where it refuses them since their camera had stopped.
  static std::optional<FramesTogether> together(const std::vector<PlacedFeatures>& parts) {
    if (parts.size() == 1) return FramesTogether{parts.front().features, {}};
    try {
      return laid_together(parts, cli::kMaxCells);
    } catch (const InvalidInput& error) {
      if (error.code() != kRepeated) throw;
      return std::nullopt;
    }
  }

  const MapView& map_;
  std::shared_ptr<const RoadDetector> detector_;
  RoadsOptions options_;
  mutable DetectedViews detected_;
};

}  // namespace

std::unique_ptr<Method> make_roads_method(const MapView& map, std::shared_ptr<const RoadDetector> detector,
                                          const RoadsOptions& options) {
  return std::make_unique<RoadsMethod>(map, std::move(detector), options);
}

}  // namespace roadfix::bench
