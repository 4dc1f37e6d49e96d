// A region of a map as MBTiles 1.3: the pictures of its Web-Mercator tiles, as the service draws them. Not for other
// modules.
#pragma once

#include <filesystem>
#include <stop_token>

#include "core/units/progress.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix {

/// Writes `file`, which does not exist yet and is to take the place of `target`. Its zooms go from the one where a
/// pixel is about a cell of the region down to the one where a single tile shows all of it: without the coarse ones a
/// viewer shows nothing unless it is close. Where nothing was observed there is no tile. Throws Interrupted
/// ("work-stopped") or IoFailure ("export-failed"), which names `target`. `progress` counts thousandths.
void write_mbtiles(const MapReader& map, const GridGeometry& region, const std::filesystem::path& file,
                   const std::filesystem::path& target, const OnProgress& progress, const std::stop_token& stop);

}  // namespace roadfix
