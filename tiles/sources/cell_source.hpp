// One source of a map as the pipeline sees it: ground that can be asked, block by block, for road cells.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/grid/geometry.hpp"
#include "core/units/provenance.hpp"

namespace roadfix {

enum class SourceKind { kImagery, kRoadRaster, kRoadVectors };

/// What a source says about itself before anything is read from it.
struct SourceSummary {
  SourceKind kind = SourceKind::kImagery;
  std::string method;         ///< detector or drawing rules with all parameters that change the cells
  std::string fingerprint;    ///< of the content of the files and of `method`
  std::string crs;            ///< as the files have it, or as the user said
  double native_gsd_m = 0.0;  ///< of imagery and rasters; 0 for vectors
  double chosen_gsd_m = 0.0;  ///< at which pixels are read, cell_m for vectors
  std::int64_t features = 0;  ///< lines drawn, for vectors
  std::int64_t left_out = 0;  ///< features that the rules leave out
  double registration_sigma_m = 0.0;
  Provenance told = {};  ///< by the files themselves; its registration error is that above, where it is told
  std::vector<std::string> notes = {};  ///< what was assumed of it, for the user to read

  bool is_lines() const { return kind == SourceKind::kRoadVectors; }
};

class CellSource {
 public:
  virtual ~CellSource() = default;

  virtual SourceSummary summary() const = 0;
  /// In the map's zone; holds every observed cell.
  virtual GridBox extent() const = 0;
  /// False only where the source has no observed cell in the box.
  virtual bool touches(const GridBox& box) const = 0;
  /// Cells of the block; unobserved where the source knows nothing. Safe to call from several threads; the same block
  /// and seed give the same cells, whatever was read before. Throws CorruptData naming file and place.
  virtual CellArray read(const GridGeometry& block, std::uint64_t seed) const = 0;
};

}  // namespace roadfix
