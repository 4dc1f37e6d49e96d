// Building a map in megapixels of imagery per second, stage by stage, on one core but for the last: what is slow shows.
#include <benchmark/benchmark.h>
#include <tbb/info.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/detect/model_files.hpp"
#include "core/detect/neural_detector.hpp"
#include "core/detect/tree_detector.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/imagery/mosaic.hpp"
#include "tiles/imagery/raster_sources.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/store/map_writer.hpp"
#include "tiles/world/world.hpp"

namespace roadfix {
namespace {

constexpr double kCellM = 2.0;
constexpr double kGsdM = 0.5;
constexpr double kSideM = 1024.0;

/// A rendered town of one square kilometre, 2048 x 2048 pixels.
class Town {
 public:
  Town() {
    world::WorldSettings settings;
    settings.width_m = settings.height_m = kSideM;
    settings.gsd_m = kGsdM;
    settings.frames = 0;
    placement_ = world::render_world(settings, folder_.path(), {}, {}).placement;
  }
  std::vector<std::string> imagery() const { return {(folder_ / "pre.tif").string()}; }
  std::filesystem::path file(const char* name) const { return folder_ / name; }
  UtmZone zone() const { return placement_.zone; }
  double megapixels() const { return placement_.cols * placement_.rows / 1e6; }
  GridBox box() const {
    const GridPoint corner = placement_.point_of(0, 0);
    return {{corner.east_m, corner.north_m - kSideM}, {corner.east_m + kSideM, corner.north_m}};
  }

 private:
  testing::TemporaryFolder folder_;
  world::Placement placement_{UtmZone::from_epsg(32637).value(), kGsdM, 0, 0, {}};
};

const Town& town() {
  static const Town kTown;
  return kTown;
}

void count_megapixels(benchmark::State& state) {
  state.counters["MP/s"] = benchmark::Counter(town().megapixels(), benchmark::Counter::kIsIterationInvariantRate);
}

/// Decoding and warping to the pixels of the network.
void read_and_warp(benchmark::State& state) {
  const Mosaic mosaic(town().imagery(), {}, ValueRule::kPicture, town().zone());
  for (auto _ : state) benchmark::DoNotOptimize(mosaic.view(town().box(), 1.0));
  count_megapixels(state);
}

void detect(benchmark::State& state, const RoadDetector& detector, double gsd_m) {
  const Mosaic mosaic(town().imagery(), {}, ValueRule::kPicture, town().zone());
  const GroundImage image = mosaic.view(town().box(), gsd_m);
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(image, kCellM, 1));
  count_megapixels(state);
}

void detect_by_tree(benchmark::State& state) { detect(state, TreeRoadDetector(TreeDetectorOptions{}), kGsdM); }

void detect_by_network(benchmark::State& state) {
  const auto model = default_model(SourceContent::kImagery);
  if (!model) {
    state.SkipWithError("no weights: set ROADFIX_MODEL");
    return;
  }
  const NeuralRoadDetector detector(*model);
  detect(state, detector, detector.preferred_gsd_m());
}

/// Sees something of everything, at no cost: what remains of an ingestion is reading and storing.
class GradientDetector : public RoadDetector {
 public:
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t, const std::stop_token&) const override {
    const cv::Mat observed = observed_cells(image, cell_m);
    CellArray cells(observed.cols, observed.rows);
    for (int row = 0; row < cells.rows(); ++row) {
      for (int col = 0; col < cells.cols(); ++col) {
        cells.at(col, row) = static_cast<Cell>(kNoRoad + (col * row) % (kRoad - kNoRoad));
      }
    }
    return cells;
  }
  double preferred_gsd_m() const override { return 1.0; }
  double halo_m() const override { return 0.0; }
  std::string name() const override { return "gradient"; }
  std::string settings() const override { return {}; }
};

/// The whole of `ingest` into a new map file.
void ingest_all(benchmark::State& state, const RoadDetector& detector, int jobs) {
  const auto source = open_imagery(town().imagery(), {}, town().zone(), kCellM, detector);
  const MapSettings settings{town().zone(), kCellM};
  for (auto _ : state) {
    state.PauseTiming();
    std::filesystem::remove(town().file("map.gpkg"));
    state.ResumeTiming();
    MapWriter writer(town().file("map.gpkg"), settings);
    SourceRecord record;
    record.name = "town";
    record.content = SourceContent::kImagery;
    record.fingerprint = source->summary().fingerprint;
    ingest(*source, record, writer, {.jobs = jobs});
  }
  count_megapixels(state);
}

void read_store_and_fuse(benchmark::State& state) { ingest_all(state, GradientDetector(), 1); }

void ingest_by_network(benchmark::State& state) {
  const auto model = default_model(SourceContent::kImagery);
  if (!model) {
    state.SkipWithError("no weights: set ROADFIX_MODEL");
    return;
  }
  ingest_all(state, NeuralRoadDetector(*model), static_cast<int>(state.range(0)));
}

BENCHMARK(read_and_warp)->Unit(benchmark::kMillisecond);
BENCHMARK(detect_by_tree)->Unit(benchmark::kMillisecond);
BENCHMARK(detect_by_network)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(read_store_and_fuse)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(ingest_by_network)
    ->Arg(1)
    ->Arg(tbb::info::default_concurrency())
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadfix
