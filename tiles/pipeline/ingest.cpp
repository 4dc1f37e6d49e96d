#include "tiles/pipeline/ingest.hpp"

#include <fmt/format.h>

#include <cassert>
#include <chrono>
#include <set>

#include "core/grid/lattice.hpp"
#include "core/units/error.hpp"
#include "core/units/splitmix.hpp"
#include "tiles/pipeline/block_flow.hpp"

namespace roadfix {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

[[noreturn]] void stopped(const std::string& source) {
  throw Interrupted(
      "work-stopped",
      fmt::format("stopped while ingesting '{}'; finished blocks are kept: run the same command again to go "
                  "on",
                  source));
}

[[noreturn]] void outside_map(const std::string& source, const MapSettings& settings) {
  throw InvalidInput("source-outside-map",
                     fmt::format("'{}' covers no ground in UTM zone EPSG:{} of the map. A new map gets the zone of the "
                                 "first layer of lines that holds any; --layer names the one with the roads, --zone "
                                 "another zone",
                                 source, settings.zone.epsg()));
}

/// The source and those in force that share ground with its version in force.
std::set<std::string> names_on_ground_of(MapWriter& writer, const std::string& source) {
  const std::vector<std::string> others = writer.sources_sharing_ground(source);
  std::set<std::string> names(others.begin(), others.end());
  names.insert(source);
  return names;
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

IngestReport ingest(const CellSource& source, const SourceRecord& record, MapWriter& writer,
                    const IngestOptions& options) {
  assert(options.jobs >= 1);
  const std::vector<TileIndex> blocks = plan_blocks(source, record.name, writer.settings());
  // An ingest that was stopped before it measured shifts leaves that to the next one.
  std::set<std::string> touched =
      writer.shifts_outdated() ? writer.sources_in_force() : names_on_ground_of(writer, record.name);
  const std::vector<TileIndex> open = writer.begin_source(record, blocks, options.replace);
  IngestReport report;
  report.blocks = std::ssize(blocks);
  report.blocks_before = report.blocks - std::ssize(open);
  const Clock::time_point start = Clock::now();
  report.observed_cells = carry_blocks({source, record.name, writer, options}, open, report.blocks_before);
  report.reading_s = seconds_since(start);
  if (options.stop.stop_requested()) stopped(record.name);

  const Clock::time_point fusing = Clock::now();
  writer.finish_source(record.name, options.on_fusing, options.stop);
  report.fusing_s = seconds_since(fusing);
  touched.merge(names_on_ground_of(writer, record.name));
  report.shifts = measure_shifts(writer, touched, options.on_shifts, options.stop);
  return report;
}

}  // namespace roadfix
