#include "cli/bench/roads_method.hpp"

#include <chrono>
#include <optional>
#include <vector>

#include "cli/bench/agreement_picture.hpp"
#include "cli/limits.hpp"
#include "core/detect/frame.hpp"
#include "core/grid/combine.hpp"
#include "core/locate/match_poses.hpp"
#include "core/locate/told_frames.hpp"
#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

constexpr const char* kRepeated = "frames-repeated";

class RoadsMethod : public Method {
 public:
  RoadsMethod(const MapView& map, std::shared_ptr<const RoadDetector> detector, const RoadsOptions& options)
      : map_(map), detector_(std::move(detector)), options_(options) {}

  Answer answer(const Query& query) const override {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<PlacedFeatures> parts = parts_of(query);
    const std::optional<FeatureMap> features = together(parts);
    Answer answer;
    if (!features) {
      answer.reason = kRepeated;
      return answer;
    }
    FixOptions options = options_.fix;
    options.scale_range = query.scale_range;
    if (parts.size() > 1) options.own_frame = parts.front().features;
    const Fix fix = locate(map_, *features, query.prior, options);
    answer.status = fix.status;
    answer.reason = fix.reason;
    answer.probability = fix.probability;
    answer.figures = fix.figures;
    if (!fix.modes.empty()) {
      answer.mode = fix.modes.front();
      answer.best = answer.mode->pose;
    }
    answer.time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (query.truth) answer.rho_at_truth = match(map_, *features, std::span(&*query.truth, 1)).front().rho;
    return answer;
  }

  cv::Mat drawn(const Query& query, const Answer& answer, std::span<const Orthoimage> imagery) const override {
    const std::vector<PlacedFeatures> parts = parts_of(query);
    const FeatureMap features = parts.size() == 1 ? parts.front().features : combined(parts, cli::kMaxCells);
    return agreement_picture(map_, imagery, query, features, answer);
  }

 private:
  FeatureMap detected(const GroundView& view) const {
    return detect_features(*detector_, view, options_.cell_m, options_.seed);
  }

  std::vector<PlacedFeatures> parts_of(const Query& query) const {
    if (query.features) return {{*query.features, {}}};
    std::vector<PlacedFeatures> parts{{detected(*query.view), {}}};
    for (const EarlierFrame& frame : query.earlier) parts.push_back({detected(frame.view), frame.offset});
    return parts;
  }

  /// As `fix` takes several frames; nullopt where it refuses them since their camera had stopped.
  static std::optional<FeatureMap> together(const std::vector<PlacedFeatures>& parts) {
    if (parts.size() == 1) return parts.front().features;
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
};

}  // namespace

std::unique_ptr<Method> make_roads_method(const MapView& map, std::shared_ptr<const RoadDetector> detector,
                                          const RoadsOptions& options) {
  return std::make_unique<RoadsMethod>(map, std::move(detector), options);
}

}  // namespace roadfix::bench
