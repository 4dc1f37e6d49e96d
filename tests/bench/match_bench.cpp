// Weighting of poses by equation (5), against a straightforward OpenCV version, and the search for a fix.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/filter/filter.hpp"
#include "core/locate/fix.hpp"
#include "core/locate/match_poses.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/track/measurement_model.hpp"
#include "core/track/particle_matches.hpp"
#include "core/units/draws.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

constexpr int kMapCells = 512;  // fits the cache of a core
constexpr int kPoses = 10'000;

const RoadGrid& small_map() {
  static const RoadGrid map = testing::street_map(1, {2.0, {300'000, -3'200'000}, kMapCells, kMapCells});
  return map;
}

FeatureMap window_of(const RoadGrid& map, int cells) {
  std::mt19937_64 random(2);
  const GridPose pose{map.geometry.cell_center(map.geometry.cols / 2, map.geometry.rows / 2), Angle::degrees(33.0)};
  return testing::observed_at(map, pose, cells, cells, map.geometry.cell_m, {0.2, 0.2}, random);
}

void count_cells(benchmark::State& state, int side) {
  const double cells = static_cast<double>(state.iterations()) * kPoses * side * side;
  state.SetItemsProcessed(state.iterations() * kPoses);
  state.counters["cells/ns"] = benchmark::Counter(cells * 1e-9, benchmark::Counter::kIsRate);
}

/// One heading bin: its footprint is turned once and used by all poses.
void equation5_kernel(benchmark::State& state) {
  const auto side = static_cast<int>(state.range(0));
  const double heading_deg = static_cast<double>(state.range(1));
  const FeatureMap window = window_of(small_map(), side);
  const PackedFootprint footprint = footprint_at(window, Angle::degrees(heading_deg));
  const MapPlane plane(small_map().cells);
  std::mt19937_64 random(3);
  std::vector<PlaneCell> places;
  const int margin = footprint.reach();
  for (int i = 0; i < kPoses; ++i) {
    places.push_back({static_cast<int>(uniform(random, margin, kMapCells - margin)),
                      static_cast<int>(uniform(random, margin, kMapCells - margin))});
  }
  std::vector<MatchSums> sums(places.size());
  for (auto _ : state) {
    match_sums(plane, footprint, places, sums);
    double best = -1.0;
    for (const MatchSums& s : sums) best = std::max(best, rho(s).value_or(-1.0));
    benchmark::DoNotOptimize(best);
  }
  count_cells(state, side);
  state.SetLabel(kernel_target());
}
BENCHMARK(equation5_kernel)->Args({64, 0})->Args({64, 30})->Args({200, 30})->Unit(benchmark::kMillisecond);

/// The plain way: per pose, the map below the footprint is warped into its frame, and OpenCV sums.
void equation5_opencv(benchmark::State& state) {
  const auto side = static_cast<int>(state.range(0));
  const auto to_float = [](const CellArray& cells) {
    cv::Mat1f image(cells.rows(), cells.cols());
    for (int r = 0; r < cells.rows(); ++r) {
      for (int c = 0; c < cells.cols(); ++c) image(r, c) = static_cast<float>(cells.at(c, r)) / 254.0F;
    }
    return image;
  };
  cv::setNumThreads(1);
  const cv::Mat1f map = to_float(small_map().cells);
  const cv::Mat1f l = to_float(window_of(small_map(), side).cells);
  std::mt19937_64 random(3);
  constexpr int kFewer = kPoses / 10;
  cv::Mat1f m;
  for (auto _ : state) {
    double best = -1.0;
    for (int i = 0; i < kFewer; ++i) {
      const double turn = uniform(random, 0, 2.0 * std::numbers::pi);
      const double c = std::cos(turn);
      const double s = std::sin(turn);
      const double half = side / 2.0;
      const double x = uniform(random, side, kMapCells - side);
      const double y = uniform(random, side, kMapCells - side);
      const cv::Matx23d map_of_footprint(c, -s, x - c * half + s * half, s, c, y - s * half - c * half);
      cv::warpAffine(map, m, map_of_footprint, l.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
      const MatchSums sums{std::int64_t{side} * side, cv::sum(m)[0], cv::sum(l)[0], m.dot(m), l.dot(l), m.dot(l)};
      best = std::max(best, rho(sums).value_or(-1.0));
    }
    benchmark::DoNotOptimize(best);
  }
  const double cells = static_cast<double>(state.iterations()) * kFewer * side * side;
  state.SetItemsProcessed(state.iterations() * kFewer);
  state.counters["cells/ns"] = benchmark::Counter(cells * 1e-9, benchmark::Counter::kIsRate);
}
BENCHMARK(equation5_opencv)->Arg(64)->Arg(200)->Unit(benchmark::kMillisecond);

/// 10,000 particles anywhere with any heading, from latitude and longitude to rho, turning of the feature map included.
void match_poses(benchmark::State& state) {
  const auto side = static_cast<int>(state.range(0));
  const MapView view = testing::view_of(small_map());
  const FeatureMap window = window_of(small_map(), side);
  std::mt19937_64 random(4);
  std::vector<GeoPose> poses;
  for (int i = 0; i < kPoses; ++i) {
    const GridPoint at{uniform(random, view.extent.min.east_m, view.extent.max.east_m),
                       uniform(random, view.extent.min.north_m, view.extent.max.north_m)};
    poses.push_back({view.zone.unproject(at), Angle::degrees(uniform(random, 0, 360))});
  }
  MatchOptions options;
  options.heading_step = Angle::degrees(2.0);
  for (auto _ : state) benchmark::DoNotOptimize(match(view, window, poses, options));
  count_cells(state, side);
}
BENCHMARK(match_poses)->Arg(64)->Unit(benchmark::kMillisecond);

/// Predict by odometry, weight by equation (5) and resample, as the steps of a track do, particles all over the map.
void filter_step(benchmark::State& state) {
  const MapView view = testing::view_of(small_map());
  const FeatureMap window = window_of(small_map(), static_cast<int>(state.range(0)));
  FilterOptions options = FilterOptions::paper(kPoses);
  PoseRegion region;
  region.box = view.extent;
  Filter filter(options, {region}, 5);
  filter.start_uniformly(region);
  OdometryCovariance covariance{};
  for (std::size_t i = 0; i < 3; ++i) covariance[i][i] = 1e-4;
  const OdometryMotion motion({5.0, 0.0, Angle::degrees(3.0)}, covariance, 1.0, 0.1);
  const MeasurementModel model;
  const auto frame_cells = static_cast<std::int64_t>(window.cells.observed_count());
  std::vector<double> log_likelihoods(kPoses);
  for (auto _ : state) {
    filter.predict(motion);
    const std::vector<MatchSums> sums = match_particles(view, window, filter.particles()).sums;
    for (std::size_t i = 0; i < sums.size(); ++i)
      log_likelihoods[i] = 0.01 * model.log_likelihood(sums[i], frame_cells, 2.0);
    benchmark::DoNotOptimize(filter.correct(log_likelihoods));
  }
  count_cells(state, static_cast<int>(state.range(0)));
}
BENCHMARK(filter_step)->Arg(64)->Unit(benchmark::kMillisecond);

const RoadGrid& town() {
  static const RoadGrid map = testing::street_map(1, {2.0, {300'000, -3'200'000}, 3250, 1900});
  return map;
}

/// Streets as regular as those of many cities, here and there one that is not: the hardest place to tell apart.
const RoadGrid& regular_city() {
  static const RoadGrid map = [] {
    const GridGeometry geometry{4.0, {150'000, -1'600'000}, 3000, 2000};
    RoadGrid city = testing::grid_city(geometry, 100.0);
    const RoadGrid others = testing::street_map(2, geometry);
    for (std::size_t i = 0; i < city.cells.cells().size(); ++i) {
      city.cells.cells()[i] = std::max(city.cells.cells()[i], others.cells.cells()[i]);
    }
    return city;
  }();
  return map;
}

/// Heading unknown, one thread; a fifth of the roads erased and as many invented. Radius 0 = the whole map; `proof`: it
/// is proven that no pose fits better.
void fix_in_region(benchmark::State& state, const RoadGrid& map, int side) {
  const MapView view = testing::view_of(map);
  const FeatureMap window = window_of(map, side);
  Prior prior;
  if (state.range(0) > 0) {
    const GridPoint centre = map.geometry.cell_center(map.geometry.cols / 2, map.geometry.rows / 2);
    prior.circle = GeoCircle{view.zone.unproject(centre), static_cast<double>(state.range(0))};
  }
  FixOptions options;
  if (state.range(1) > 0) options.search.proof_time = std::chrono::minutes(10);
  Fix fix;
  for (auto _ : state) fix = locate(view, window, prior, options);
  state.counters["km2"] = fix.searched_km2;
  state.counters["headings"] = fix.headings;
  state.SetLabel((fix.status == FixStatus::kFix ? "fix" : "no fix: " + fix.reason) +
                 (fix.proof && fix.proof->complete ? ", proven" : ""));
}
void fix_in_town(benchmark::State& state) { fix_in_region(state, town(), 200); }
void fix_in_regular_city(benchmark::State& state) { fix_in_region(state, regular_city(), 150); }
BENCHMARK(fix_in_town)
    ->ArgNames({"radius_m", "proof"})
    ->Args({200, 0})
    ->Args({200, 1})
    ->Args({1000, 0})
    ->Args({1000, 1})
    ->Args({0, 0})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(fix_in_regular_city)
    ->ArgNames({"radius_m", "proof"})
    ->Args({1000, 0})
    ->Args({1000, 1})
    ->Args({0, 0})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadfix
