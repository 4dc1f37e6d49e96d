// A map as a GDAL dataset, so that any GDAL driver can copy it block by block. Not for other modules.
#pragma once

#include <gdal_priv.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "tiles/store/map_reader.hpp"

namespace roadfix {

enum class PixelKind {
  kProbability,  ///< one Float32 band, 0..1, nodata -1
  kPicture,      ///< two Byte bands: grey 0..254, alpha 0 or 255
};

/// What an exported file says of itself.
std::string description_of(const MapInfo& info);

/// Description, credits and what ingest reads back, as metadata of a file that is made of the map.
void describe(GDALDataset& dataset, PixelKind kind, const MapInfo& info);

class MapDataset final : public GDALDataset {
 public:
  /// `map` must outlive it. Of so many overviews, each in cells of twice the size, which the map keeps: the geometry
  /// must lie on the lattice of the coarsest. An exception of the map ends the copy with a GDAL error;
  /// rethrow_failure() then throws it.
  MapDataset(const MapReader& map, const GridGeometry& geometry, PixelKind kind, int overviews = 0);

  CPLErr GetGeoTransform(double* transform) override;
  const OGRSpatialReference* GetSpatialRef() const override;

  /// Cells under a block of 256 x 256 pixels; smaller at the eastern and southern edge.
  const CellArray& block(int col, int row);
  /// Whether the map has no tile under these pixels.
  bool is_gap(int x, int y, int width, int height) const;
  int overviews() const { return static_cast<int>(overviews_.size()); }
  MapDataset* overview(int index) { return overviews_[static_cast<std::size_t>(index)].get(); }
  void keep_failure() { failure_ = std::current_exception(); }
  void rethrow_failure() const;

 private:
  const MapReader& map_;
  GridGeometry geometry_;
  OGRSpatialReference reference_;
  double stored_cell_m_ = 0.0;  ///< of the level of the map that is read
  std::set<TileIndex> stored_;  ///< its tiles
  std::vector<std::unique_ptr<MapDataset>> overviews_;
  std::exception_ptr failure_;
  TileIndex last_index_{-1, -1};
  CellArray last_;
};

}  // namespace roadfix
