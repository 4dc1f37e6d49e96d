// The localizability of places as Web-Mercator pictures: squares of ground, each with the answer of its middle.
//
// The squares of a zoom lie on one lattice over the whole map, whatever tile shows them, and those of a coarser zoom
// have their middles among those of the finer ones: what was found out once serves every tile.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "tiles/mercator/tile_picture.hpp"

namespace roadfix::api {

/// What a frame of a place would give.
struct PlaceAnswer {
  bool fix = false;          ///< whether it would be a fix
  double probability = 0.0;  ///< that it would be placed rightly
};
/// nullopt where the map shows too little to say.
using AnswerAt = std::function<std::optional<PlaceAnswer>(GridPoint place)>;

/// At most so many squares side by side in a tile, beside those that its borders cut.
inline constexpr int kSquaresAcross = 4;

/// Side of the squares at a zoom: half the footprint, doubled until kSquaresAcross of them are as wide as a tile.
/// nullopt at zooms where they would be larger than four footprints: one place does not speak for so much ground.
std::optional<double> square_m(const MapView& map, int zoom, double footprint_m);

/// The zooms at which tiles show something new: the first that is drawn, and the first with the smallest squares.
struct ZoomRange {
  int first = 0;
  int last = 0;
};
ZoomRange localizability_zooms(const MapView& map, double footprint_m);

/// PNG of 256 x 256 pixels: green where it would be a fix, else from red (probability 0) to yellow (1), half
/// transparent, or grey = probability; nullopt where there is nothing to show. Asks for each square at most once, and
/// only within the map's extent.
std::optional<std::vector<std::byte>> localizability_png(const MapView& map, mercator::TileAddress tile,
                                                         double footprint_m, mercator::TileStyle style,
                                                         const AnswerAt& answer_at);

}  // namespace roadfix::api
