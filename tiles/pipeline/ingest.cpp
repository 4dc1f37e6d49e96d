#include "tiles/pipeline/ingest.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <exception>
#include <mutex>
#include <utility>

#include "core/grid/lattice.hpp"
#include "core/units/error.hpp"
#include "core/units/splitmix.hpp"

namespace roadfix {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

using Block = FinishedBlock;  // without cells where it could not be read

[[noreturn]] void stopped(const std::string& source) {
  throw Interrupted(
      "ingest-stopped",
      fmt::format("stopped while ingesting '{}'; finished blocks are kept: run the same command again to go "
                  "on",
                  source));
}

[[noreturn]] void outside_map(const std::string& source, const MapSettings& settings) {
  throw InvalidInput("source-outside-map",
                     fmt::format("'{}' covers no ground in UTM zone EPSG:{} of the map", source, settings.zone.epsg()));
}

/// The first failure of any stage. A pipeline that an exception cancels leaks the blocks in flight (oneTBB 2021.8), so
/// the stages keep it here, nothing new is begun, and blocks that were read already are still written.
class FirstFailure {
 public:
  template <typename Work>
  void guard(const Work& work) noexcept {
    try {
      work();
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      failed_ = true;
    }
  }
  bool failed() const noexcept { return failed_; }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::atomic<bool> failed_ = false;
};

/// Writes blocks as they come, but where they come fast a tenth of a second of them at a time: the disk takes longer to
/// confirm a transaction than it takes to draw roads. Killed in between, the ingest draws those again.
class BlockWriter {
 public:
  BlockWriter(MapWriter& writer, const std::string& source) : writer_(writer), source_(source) {}

  /// Returns the blocks written by now, this one or none or several.
  std::vector<Block> add(Block block) {
    constexpr double kGatheringS = 0.1;
    gathered_.push_back(std::move(block));
    return seconds_since(last_) >= kGatheringS ? write() : std::vector<Block>();
  }
  std::vector<Block> write() {
    std::vector<Block> blocks = std::exchange(gathered_, {});
    if (!blocks.empty()) writer_.put_blocks(source_, blocks);
    last_ = Clock::now();
    return blocks;
  }

 private:
  MapWriter& writer_;
  const std::string& source_;
  std::vector<Block> gathered_;
  Clock::time_point last_ = Clock::now();
};

/// Reads and writes the blocks; returns the number of observed cells.
std::int64_t carry(const CellSource& source, const std::string& name, double cell_m, std::span<const TileIndex> todo,
                   std::int64_t before, MapWriter& writer, const IngestOptions& options, const IngestProgress& progress,
                   const std::stop_token& stop) {
  const auto total = before + static_cast<std::int64_t>(todo.size());
  std::int64_t done = before;
  std::int64_t observed = 0;
  std::size_t next = 0;
  FirstFailure failure;
  if (progress.blocks) progress.blocks(done, total);
  const auto plan = [&](tbb::flow_control& control) -> std::size_t {
    if (next == todo.size() || stop.stop_requested() || failure.failed()) {
      control.stop();
      return 0;
    }
    return next++;
  };
  const auto read = [&](std::size_t i) {
    Block block{todo[i], {}};
    failure.guard(
        [&] { block.cells = source.read(tile_geometry(block.index, cell_m), block_seed(options.seed, block.index)); });
    return block;
  };
  BlockWriter blocks(writer, name);
  const auto count = [&](const std::vector<Block>& written) {
    for (const Block& block : written) {
      observed += static_cast<std::int64_t>(block.cells.observed_count());
      if (progress.blocks) progress.blocks(++done, total);
    }
  };
  const auto write = [&](Block block) {
    if (!block.cells.empty()) failure.guard([&] { count(blocks.add(std::move(block))); });
  };
  const auto tokens = static_cast<std::size_t>(2 * options.jobs);
  // More jobs than processors are the user's choice: reading may wait for a disk or a network.
  const auto threads = static_cast<std::size_t>(std::max(options.jobs, tbb::info::default_concurrency()));
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(options.jobs);
  arena.execute([&] {
    tbb::parallel_pipeline(tokens, tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, plan) &
                                       tbb::make_filter<std::size_t, Block>(tbb::filter_mode::parallel, read) &
                                       tbb::make_filter<Block, void>(tbb::filter_mode::serial_out_of_order, write));
  });
  failure.guard([&] { count(blocks.write()); });
  failure.rethrow();
  return observed;
}

}  // namespace

std::vector<TileIndex> plan_blocks(const CellSource& source, const std::string& name, const MapSettings& settings) {
  constexpr double kMaxBlocks = 1e6;
  const GridBox box = intersection(source.extent(), {kLattice.min, {kEastmostM, kLattice.max.north_m}});
  if (box.empty()) outside_map(name, settings);
  const double tile_m = kTileCells * settings.cell_m;
  if (box.width_m() / tile_m * box.height_m() / tile_m > kMaxBlocks) {
    throw LimitExceeded(
        "source-too-large",
        fmt::format("'{}' covers {:.0f} x {:.0f} km, more than a million blocks of {:.0f} m: choose larger cells with "
                    "--cell, or split it. If a stray road far away makes it so large, name the ground with --extent",
                    name, box.width_m() / 1e3, box.height_m() / 1e3, tile_m));
  }
  std::vector<TileIndex> blocks = tiles_covering(GridGeometry::covering(box, settings.cell_m));
  std::erase_if(blocks, [&](TileIndex tile) {
    const GridBox ground = tile_geometry(tile, settings.cell_m).box();
    return ground.max.east_m > kEastmostM || !source.touches(ground);
  });
  if (blocks.empty()) outside_map(name, settings);
  return blocks;
}

std::uint64_t block_seed(std::uint64_t seed, TileIndex block) {
  const auto col = static_cast<std::uint32_t>(block.col);
  const auto row = static_cast<std::uint32_t>(block.row);
  return SplitMix64(SplitMix64(seed).next() ^ ((std::uint64_t{row} << 32U) | col)).next();
}

IngestReport ingest(const CellSource& source, const SourceRecord& record, const MapSettings& settings,
                    MapWriter& writer, const IngestOptions& options, const IngestProgress& progress,
                    std::stop_token stop) {
  assert(options.jobs >= 1);
  const std::vector<TileIndex> blocks = plan_blocks(source, record.name, settings);
  const std::vector<TileIndex> todo = writer.begin_source(record, blocks, options.replace);
  IngestReport report;
  report.blocks = static_cast<std::int64_t>(blocks.size());
  report.blocks_before = report.blocks - static_cast<std::int64_t>(todo.size());
  const Clock::time_point start = Clock::now();
  report.observed_cells =
      carry(source, record.name, settings.cell_m, todo, report.blocks_before, writer, options, progress, stop);
  report.reading_s = seconds_since(start);
  if (stop.stop_requested()) stopped(record.name);
  const Clock::time_point fusing = Clock::now();
  writer.finish_source(record.name, progress.fusing, stop);
  report.fusing_s = seconds_since(fusing);
  return report;
}

}  // namespace roadfix
