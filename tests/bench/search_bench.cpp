// The search of a whole city, of a prior's circle, and what the same takes with OpenCV and by brute force. The map is
// the file that ROADFIX_BENCH_MAP names, in cells of 4 m, as docs/benchmarks.md says how to make it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <random>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/locate/fix.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/survey/simulate.hpp"
#include "tiles/view/map_file_view.hpp"

namespace roadfix {
namespace {

constexpr int kSide = 150;  // cells of 4 m: 600 m
constexpr int kQueries = 5;
constexpr std::size_t kKept = std::size_t{2} << 30;

struct Query {
  GridPoint position;
  FeatureMap features;
};

struct City {
  MapView view;
  std::vector<Query> queries;
};

/// A fifth of the roads erased and as many invented.
FeatureQuality fifth_wrong() {
  FeatureQuality quality;
  quality.erase = quality.invent = 0.2;
  return quality;
}

/// Over ground that has roads.
Query query_at(const MapView& view, std::uint64_t seed, const FeatureQuality& quality) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (;;) {
    const GridPose pose{{view.extent.min.east_m + share(random) * view.extent.width_m(),
                         view.extent.min.north_m + share(random) * view.extent.height_m()},
                        Angle::degrees(360.0 * share(random))};
    const double reach = 0.8 * kSide * view.cell_m;
    const RoadGrid ground =
        view.read(GridGeometry::covering({{pose.position.east_m - reach, pose.position.north_m - reach},
                                          {pose.position.east_m + reach, pose.position.north_m + reach}},
                                         view.cell_m));
    const auto roads = std::ranges::count_if(ground.cells.cells(), [](Cell c) { return is_observed(c) && c > 127; });
    if (static_cast<double>(roads) < 0.05 * static_cast<double>(ground.cells.cells().size())) continue;
    return {pose.position, simulate_features(ground, pose, kSide, kSide, quality, random)};
  }
}

const City* city() {
  static const std::optional<City> kCity = []() -> std::optional<City> {
    const char* path = std::getenv("ROADFIX_BENCH_MAP");
    if (path == nullptr) return std::nullopt;
    City opened{view_of(std::make_shared<const MapReader>(path, kKept), "city"), {}};
    for (std::uint64_t seed = 1; seed <= kQueries; ++seed)
      opened.queries.push_back(query_at(opened.view, seed, fifth_wrong()));
    return opened;
  }();
  return kCity ? &*kCity : nullptr;
}

/// One thread, heading unknown. Warm: what an earlier search of the same part built is there.
void search_city(benchmark::State& state) {
  if (city() == nullptr) return state.SkipWithError("ROADFIX_BENCH_MAP names no map");
  MapView view = city()->view;
  const bool warm = state.range(1) != 0;
  FixOptions options;
  if (state.range(2) > 0) options.search.proof_time = std::chrono::seconds(state.range(2));
  options.search.scale_range = static_cast<double>(state.range(3)) / 100.0;
  int asked = 0;
  int right = 0;
  int fixes = 0;
  int proven = 0;
  Fix fix;
  const auto ask = [&](const Query& query) {
    Prior prior;
    if (state.range(0) > 0) {
      prior.circle = GeoCircle{view.zone.unproject({query.position.east_m + 300.0, query.position.north_m - 200.0}),
                               static_cast<double>(state.range(0))};
    }
    fix = locate(view, query.features, prior, options);
    return !fix.modes.empty() &&
           distance_m(view.zone.project(fix.modes.front().pose.position), query.position) <= 2.0 * view.cell_m;
  };
  if (warm) {
    view.searches = std::make_shared<SearchCache>(kKept);
    for (const Query& query : city()->queries) ask(query);
  }
  for (auto _ : state) {
    right += ask(city()->queries[static_cast<std::size_t>(asked % kQueries)]) ? 1 : 0;
    ++asked;
    fixes += fix.status == FixStatus::kFix ? 1 : 0;
    proven += fix.proof && fix.proof->complete ? 1 : 0;
  }
  state.counters["km2"] = fix.searched_km2;
  state.counters["headings"] = fix.headings;
  state.counters["scales"] = fix.scales;
  state.counters["asked"] = asked;
  state.counters["right"] = right;
  state.counters["fixes"] = fixes;
  state.counters["proven"] = proven;
  if (view.searches) state.counters["MiB_kept"] = static_cast<double>(view.searches->bytes()) / (1 << 20);
}
BENCHMARK(search_city)
    ->ArgNames({"radius_m", "warm", "proof_s", "scale_percent"})
    ->Args({1000, 0, 0, 0})
    ->Args({1000, 1, 0, 0})
    ->Args({0, 0, 0, 0})
    ->Args({0, 1, 0, 0})
    ->Args({1000, 1, 0, 15})
    ->Args({1000, 0, 60, 0})
    ->Args({1000, 1, 60, 0})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(kQueries);
BENCHMARK(search_city)
    ->Name("prove_city")
    ->ArgNames({"radius_m", "warm", "proof_s", "scale_percent"})
    ->Args({4000, 0, 600, 0})
    ->Args({0, 0, 600, 0})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

/// What an altitude or a tilt that is known roughly costs: circles of 1 km, feature maps of another size than they say
/// (1 sigma) and tilted (1 sigma per axis), with and without a range of sizes to search.
void search_misjudged(benchmark::State& state) {
  if (city() == nullptr) return state.SkipWithError("ROADFIX_BENCH_MAP names no map");
  MapView view = city()->view;
  view.searches = std::make_shared<SearchCache>(kKept);
  FeatureQuality quality = fifth_wrong();
  quality.scale = static_cast<double>(state.range(0)) / 100.0;
  quality.tilt_deg = static_cast<double>(state.range(1));
  FixOptions options;
  options.search.scale_range = static_cast<double>(state.range(2)) / 100.0;
  std::uint64_t seed = 0;
  int right = 0;
  int fixes = 0;
  int wrong_fixes = 0;
  double probability = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    const Query query = query_at(view, 100 + seed++, quality);
    Prior prior;
    prior.circle =
        GeoCircle{view.zone.unproject({query.position.east_m + 300.0, query.position.north_m - 200.0}), 1000.0};
    state.ResumeTiming();
    const Fix fix = locate(view, query.features, prior, options);
    constexpr double kRightM = 25.0;
    const bool is_right =
        !fix.modes.empty() && distance_m(view.zone.project(fix.modes.front().pose.position), query.position) <= kRightM;
    right += is_right ? 1 : 0;
    fixes += fix.status == FixStatus::kFix ? 1 : 0;
    wrong_fixes += fix.status == FixStatus::kFix && !is_right ? 1 : 0;
    probability += fix.probability;
  }
  state.counters["asked"] = static_cast<double>(seed);
  state.counters["right"] = right;
  state.counters["fixes"] = fixes;
  state.counters["wrong_fixes"] = wrong_fixes;
  state.counters["probability"] = benchmark::Counter(probability, benchmark::Counter::kAvgIterations);
}
BENCHMARK(search_misjudged)
    ->ArgNames({"scale_error_percent", "tilt_deg", "scale_range_percent"})
    ->Args({0, 0, 0})
    ->Args({5, 0, 0})
    ->Args({5, 0, 15})
    ->Args({0, 2, 0})
    ->Args({0, 5, 0})
    ->Args({0, 5, 15})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(20);

/// The square around a circle of 1 km about the first query, in cells of 4 m, and its feature map at one heading.
struct Around {
  RoadGrid map;
  FeatureMap turned;
};
Around around() {
  const Query& query = city()->queries.front();
  const double reach = 1000.0 + 0.75 * kSide * city()->view.cell_m;
  return {city()->view.read(GridGeometry::covering({{query.position.east_m - reach, query.position.north_m - reach},
                                                    {query.position.east_m + reach, query.position.north_m + reach}},
                                                   city()->view.cell_m)),
          rotated(query.features, Angle::degrees(30.0))};
}

/// Masked and normalised; the search needs one such pass for each of 472 headings.
void one_heading_by_opencv(benchmark::State& state) {
  if (city() == nullptr) return state.SkipWithError("ROADFIX_BENCH_MAP names no map");
  const Around given = around();
  const auto image = [](const CellArray& cells) {
    cv::Mat1f values(cells.rows(), cells.cols(), 0.0F);
    for (int r = 0; r < cells.rows(); ++r) {
      for (int c = 0; c < cells.cols(); ++c) {
        if (is_observed(cells.at(c, r))) values(r, c) = static_cast<float>(cells.at(c, r)) / 254.0F;
      }
    }
    return values;
  };
  const cv::Mat1f map = image(given.map.cells);
  const cv::Mat1f patch = image(given.turned.cells);
  cv::Mat1f mask(patch.size(), 0.0F);
  for (int r = 0; r < mask.rows; ++r) {
    for (int c = 0; c < mask.cols; ++c) mask(r, c) = is_observed(given.turned.cells.at(c, r)) ? 1.0F : 0.0F;
  }
  cv::setNumThreads(1);
  cv::Mat1f scores;
  for (auto _ : state) cv::matchTemplate(map, patch, scores, cv::TM_CCOEFF_NORMED, mask);
  state.counters["poses"] =
      benchmark::Counter(static_cast<double>(scores.total()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(one_heading_by_opencv)->Unit(benchmark::kMillisecond);

void one_heading_by_brute_force(benchmark::State& state) {
  if (city() == nullptr) return state.SkipWithError("ROADFIX_BENCH_MAP names no map");
  const Around given = around();
  const PackedFootprint footprint(given.turned);
  const MapPlane plane(given.map.cells);
  std::vector<PlaneCell> places;
  for (int row = footprint.reach(); row < plane.rows() - footprint.reach(); ++row) {
    for (int col = footprint.reach(); col < plane.cols() - footprint.reach(); ++col) places.push_back({col, row});
  }
  std::vector<MatchSums> sums(places.size());
  double best = 0.0;
  for (auto _ : state) {
    match_sums(plane, footprint, places, sums);
    for (const MatchSums& s : sums) best = std::max(best, score_of(s, {footprint.observed_cells(), 1.0}));
  }
  benchmark::DoNotOptimize(best);
  state.counters["poses"] =
      benchmark::Counter(static_cast<double>(places.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(one_heading_by_brute_force)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadfix
