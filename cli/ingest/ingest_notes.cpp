#include "cli/ingest/ingest_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>

#include "cli/shift_text.hpp"
#include "core/units/shell_word.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix::cli {
namespace {

/// What it means and, where `advised`, what to do about it.
void print_shift_note(const std::string& source, const ShiftReport::Shifted& shifted, bool advised) {
  const SourceShift& shift = shifted.shift;
  fmt::print(
      stderr,
      "note: '{}' would fit the other sources of the map better about {} from where it lies (correlation of the "
      "roads {:.2f} instead of {:.2f}): places on its ground count as known within {:.3g} m (1 sigma) instead of "
      "{:.3g} m\n",
      source, directions_of(shift), shift.correlation, shift.correlation_in_place, shift.sigma_m,
      shifted.stated_sigma_m);
  if (!advised) return;
  fmt::print(stderr,
             "      Nobody knows which of them is right, and fewer places are found: check the georeference of both "
             "(--crs). Where one is known to be wrong, ingest that one with --registration-sigma {:.0f}, and the other "
             "one keeps what it states\n",
             std::ceil(shift.sigma_m));
}

/// The longest part of the range that a single cell can hold.
double longest_in_a_cell(double from_m, double to_m, double cell_m) {
  const double edge_m = (std::floor(from_m / cell_m) + 1.0) * cell_m;  // the first beyond `from_m`
  if (to_m >= edge_m + cell_m) return cell_m;
  return std::max(std::min(to_m, edge_m) - from_m, to_m - edge_m);
}

/// As a cell of pixels has to be filled to count as observed.
bool fills_half_a_cell(const GridBox& box, double cell_m) {
  return 2.0 * longest_in_a_cell(box.min.east_m, box.max.east_m, cell_m) *
             longest_in_a_cell(box.min.north_m, box.max.north_m, cell_m) >=
         cell_m * cell_m;
}

}  // namespace

std::optional<std::string> note_on_distance(const CellSource& source, const std::optional<MapInfo>& map) {
  constexpr double kNearM = 10e3;
  if (!map || map->extent.empty()) return std::nullopt;
  const GridBox known = map->extent;
  const GridBox own = source.extent();
  const GridBox both = united(own, known);
  const double away_m = std::hypot(std::max(0.0, both.width_m() - own.width_m() - known.width_m()),
                                   std::max(0.0, both.height_m() - own.height_m() - known.height_m()));
  if (away_m <= std::max({kNearM, known.width_m(), known.height_m()})) return std::nullopt;
  return fmt::format(
      "it lies {:.0f} km from all that the map holds, which is {:.1f} x {:.1f} km. If it belongs elsewhere, latitude "
      "and longitude may be swapped in it, or its reference system is wrong (--crs gives the right one); roadfix "
      "remove takes it out of the map",
      away_m / 1e3, known.width_m() / 1e3, known.height_m() / 1e3);
}

std::optional<std::string> note_on_nothing_replaced(const std::optional<MapInfo>& map, const std::string& source) {
  constexpr std::size_t kNamed = 8;
  if (!map) return std::nullopt;
  std::set<std::string> names;
  for (const SourceStatus& status : map->sources) names.insert(status.record.name);
  if (names.empty() || names.contains(source)) return std::nullopt;
  const auto last = std::next(names.begin(), std::min(std::ssize(names), std::ptrdiff_t{kNamed}));
  return fmt::format(
      "--replace replaces nothing: the map has no source '{}', it has '{}'{}. If this is a newer version of one of "
      "them, take the older one out (roadfix remove); with its --name it would have been replaced",
      source, fmt::join(names.begin(), last, "', '"), last == names.end() ? "" : " and others");
}

std::optional<std::string> note_on_ground_lost(const CellSource& newer, const std::string& map,
                                               const std::string& source, double cell_m) {
  constexpr std::ptrdiff_t kParts = 10;  // one of them may go: the edges of two pictures differ
  const std::set<TileIndex> blocks = blocks_in_force(map, source);
  const auto lost = std::ranges::count_if(
      blocks, [&](TileIndex block) { return !newer.touches(tile_geometry(block, cell_m).box()); });
  if (lost * kParts <= std::ssize(blocks)) return std::nullopt;
  const double block_km2 = std::pow(kTileCells * cell_m / 1e3, 2);
  return fmt::format(
      "--replace takes {:.1f} of {:.1f} km2 of the old '{}' out of the map, which this one does not cover. If it shows "
      "a part only, ingest it with another --name instead",
      static_cast<double>(lost) * block_km2, static_cast<double>(blocks.size()) * block_km2, source);
}

std::string why_nothing_observed(const CellSource& source, double cell_m) {
  if (source.summary().is_lines()) return "its --extent holds the centre of no cell";
  if (fills_half_a_cell(source.extent(), cell_m)) {
    return "all its pixels are nodata, transparent, no numbers or in one colour";
  }
  return fmt::format(
      "it is so small that it fills half of no cell: these are {:g} m, and smaller ones take a map of their own "
      "(--cell)",
      cell_m);
}

void note_copies(const std::vector<std::string>& twins, const std::string& source, const std::string& map,
                 const ShiftReport& shifts) {
  std::set<std::string> copies(twins.begin(), twins.end());
  if (const auto found = shifts.copies.find(source); found != shifts.copies.end()) {
    copies.insert(found->second.begin(), found->second.end());
  }
  for (const std::string& copy : copies) {
    const bool exact = std::ranges::find(twins, copy) != twins.end();
    const std::string agrees = exact ? fmt::format("says exactly what the source '{}' says", copy)
                                     : fmt::format("agrees with the source '{}' as only a copy does", copy);
    fmt::print(stderr,
               "note: '{}' {}, and counts with it as one where other sources differ. If {}: roadfix remove {} {}\n",
               source, agrees,
               exact ? "it is the same content, take it out" : "one was made of the other, take the worse one out",
               shell_word(map), shell_word(source));
  }
}

void note_shifts(const std::string& source, const ShiftReport& shifts) {
  std::vector<std::string> names;
  for (const auto& [name, shift] : shifts.shifted) names.insert(name == source ? names.begin() : names.end(), name);
  for (const std::string& name : names) {
    print_shift_note(name, shifts.shifted.at(name), name == names.front());
  }
  for (const std::string& note : shifts.notes) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace roadfix::cli
