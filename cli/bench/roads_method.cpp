#include "cli/bench/roads_method.hpp"

#include <chrono>

#include "core/detect/frame.hpp"

namespace roadfix::bench {
namespace {

class RoadsMethod : public Method {
 public:
  RoadsMethod(const MapView& map, const RoadDetector& detector, const RoadsOptions& options)
      : map_(map), detector_(detector), options_(options) {}

  Answer answer(const Query& query) const override {
    const auto start = std::chrono::steady_clock::now();
    const FeatureMap features =
        query.features ? *query.features
                       : detect_features(detector_, rectified(*query.picture), options_.cell_m, options_.seed);
    const Fix fix = locate(map_, features, query.prior, options_.fix);
    Answer answer{fix.status, fix.reason, {}, fix.probability, 0.0};
    if (!fix.modes.empty()) answer.best = fix.modes.front().pose;
    answer.time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return answer;
  }

 private:
  const MapView& map_;
  const RoadDetector& detector_;
  RoadsOptions options_;
};

}  // namespace

std::unique_ptr<Method> make_roads_method(const MapView& map, const RoadDetector& detector,
                                          const RoadsOptions& options) {
  return std::make_unique<RoadsMethod>(map, detector, options);
}

}  // namespace roadfix::bench
