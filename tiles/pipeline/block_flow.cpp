#include "tiles/pipeline/block_flow.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace roadfix {
namespace {

/// The first failure of any stage. A pipeline that an exception cancels leaks the blocks in flight (oneTBB 2021.8):
/// stages keep the exception here instead, no new block is begun, and blocks that were read already are still written.
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

/// Writes blocks as they come, but at most ten times a second: roads are drawn faster than a disk confirms
/// transactions. An ingest that is killed in between has to draw those blocks again.
class BlockWriter {
 public:
  BlockWriter(const BlockFlow& flow, std::int64_t done, std::int64_t total) : flow_(flow), done_(done), total_(total) {
    tell();
  }

  void add(FinishedBlock block) {
    constexpr auto kGathering = std::chrono::milliseconds(100);
    gathered_.push_back(std::move(block));
    if (Clock::now() - last_ >= kGathering) write();
  }

  void write() {
    const std::vector<FinishedBlock> blocks = std::exchange(gathered_, {});
    if (!blocks.empty()) flow_.writer.put_blocks(flow_.name, blocks);
    last_ = Clock::now();
    for (const FinishedBlock& block : blocks) {
      observed_cells_ += static_cast<std::int64_t>(block.cells.observed_count());
      ++done_;
      tell();
    }
  }

  std::int64_t observed_cells() const { return observed_cells_; }

 private:
  using Clock = std::chrono::steady_clock;

  void tell() const {
    if (flow_.options.on_blocks) flow_.options.on_blocks(done_, total_);
  }

  const BlockFlow& flow_;
  std::int64_t done_;
  std::int64_t total_;
  std::int64_t observed_cells_ = 0;
  std::vector<FinishedBlock> gathered_;
  Clock::time_point last_ = Clock::now();
};

FinishedBlock read(const BlockFlow& flow, TileIndex block) {
  const GridGeometry ground = tile_geometry(block, flow.writer.settings().cell_m);
  return {block, flow.source.read(ground, block_seed(flow.options.seed, block))};
}

}  // namespace

std::int64_t carry_blocks(const BlockFlow& flow, std::span<const TileIndex> open, std::int64_t done) {
  const IngestOptions& options = flow.options;
  BlockWriter writer(flow, done, done + std::ssize(open));
  FirstFailure failure;
  using Block = std::optional<FinishedBlock>;  // nullopt where it could not be read
  std::size_t next = 0;
  const auto begin_next = [&](tbb::flow_control& control) -> std::size_t {
    if (next < open.size() && !options.stop.stop_requested() && !failure.failed()) return next++;
    control.stop();
    return 0;
  };
  const auto read_block = [&](std::size_t index) {
    Block block;
    failure.guard([&] { block = read(flow, open[index]); });
    return block;
  };
  const auto write_block = [&](Block block) {
    if (block) failure.guard([&] { writer.add(*std::move(block)); });
  };
  // More jobs than processors are the user's choice: reading may wait for a disk or a network.
  const auto threads = static_cast<std::size_t>(std::max(options.jobs, tbb::info::default_concurrency()));
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, threads);
  const auto in_flight = static_cast<std::size_t>(2 * options.jobs);
  tbb::task_arena(options.jobs).execute([&] {
    tbb::parallel_pipeline(in_flight,
                           tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, begin_next) &
                               tbb::make_filter<std::size_t, Block>(tbb::filter_mode::parallel, read_block) &
                               tbb::make_filter<Block, void>(tbb::filter_mode::serial_out_of_order, write_block));
  });
  failure.guard([&] { writer.write(); });
  failure.rethrow();
  return writer.observed_cells();
}

}  // namespace roadfix
