#include "tiles/export/map_dataset.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include "tiles/export/probability_pixel.hpp"
#include "tiles/sources/exported_roads.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

/// One band: `pixel` makes its value from a cell.
template <typename Value, Value (*pixel)(Cell)>
class MapBand final : public GDALRasterBand {
 public:
  MapBand(MapDataset& map, int number, GDALDataType type, GDALColorInterp colour, const char* name)
      : map_(map), colour_(colour) {
    poDS = &map;
    nBand = number;
    eDataType = type;
    nBlockXSize = kTileCells;
    nBlockYSize = kTileCells;
    GDALRasterBand::SetDescription(name);
  }

  double GetNoDataValue(int* success) override {
    const bool has = colour_ == GCI_Undefined;
    if (success != nullptr) *success = has ? TRUE : FALSE;
    return has ? static_cast<double>(kNoData) : 0.0;
  }
  GDALColorInterp GetColorInterpretation() override { return colour_; }

  int GetOverviewCount() override { return map_.overviews(); }
  GDALRasterBand* GetOverview(int index) override {
    return index < 0 || index >= map_.overviews() ? nullptr : map_.overview(index)->GetRasterBand(nBand);
  }

  /// So that copies leave the gaps between towns out, however wide they are.
  int IGetDataCoverageStatus(int x, int y, int width, int height, int, double* percent) override {
    const bool empty = map_.is_gap(x, y, width, height);
    if (percent != nullptr) *percent = empty ? 0.0 : 100.0;
    return empty ? GDAL_DATA_COVERAGE_STATUS_EMPTY : GDAL_DATA_COVERAGE_STATUS_DATA;
  }

  /// GDAL is C below: no exception may leave.
  CPLErr IReadBlock(int col, int row, void* image) override {
    try {
      auto* out = static_cast<Value*>(image);
      std::fill_n(out, kTileCells * kTileCells, pixel(kUnobserved));
      if (map_.is_gap(col * kTileCells, row * kTileCells, kTileCells, kTileCells)) return CE_None;
      const CellArray& cells = map_.block(col, row);
      for (int r = 0; r < cells.rows(); ++r) std::ranges::transform(cells.row(r), out + r * kTileCells, pixel);
      return CE_None;
    } catch (const std::exception& error) {
      map_.keep_failure();
      CPLError(CE_Failure, CPLE_AppDefined, "%s", error.what());
      return CE_Failure;
    }
  }

 private:
  MapDataset& map_;
  GDALColorInterp colour_;
};

GByte grey_pixel(Cell cell) { return is_observed(cell) ? cell : 0; }
GByte alpha_pixel(Cell cell) { return is_observed(cell) ? 255 : 0; }

}  // namespace

std::string description_of(const MapInfo& info) {
  return std::string(kExportedRoads) + ", from version " + info.version + " of its map";
}

void describe(GDALDataset& dataset, PixelKind kind, const MapInfo& info) {
  for (const auto& [name, value] : provenance_items(provenance_of(info))) {
    dataset.SetMetadataItem(name.c_str(), value.c_str());
  }
  if (kind != PixelKind::kProbability) return;
  dataset.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", description_of(info).c_str());
  const std::string credits = credits_of(info);
  if (!credits.empty()) dataset.SetMetadataItem("TIFFTAG_COPYRIGHT", credits.c_str());
}

MapDataset::MapDataset(const MapReader& map, const GridGeometry& geometry, PixelKind kind, int overviews)
    : map_(map), geometry_(geometry), reference_(utm_reference(map.info().settings.zone)) {
  const double finest_m = map.info().settings.cell_m;
  const int level = std::min(std::ilogb(geometry.cell_m / finest_m), map.info().levels - 1);
  stored_cell_m_ = std::ldexp(finest_m, level);
  const auto tiles = map.tiles(level);
  stored_.insert(tiles.begin(), tiles.end());
  nRasterXSize = geometry.cols;
  nRasterYSize = geometry.rows;
  describe(*this, kind, map.info());
  if (kind == PixelKind::kProbability) {
    SetBand(1, new MapBand<float, probability_pixel>(*this, 1, GDT_Float32, GCI_Undefined, "probability of road"));
  } else {
    SetBand(1, new MapBand<GByte, grey_pixel>(*this, 1, GDT_Byte, GCI_GrayIndex, "probability of road x 254"));
    SetBand(2, new MapBand<GByte, alpha_pixel>(*this, 2, GDT_Byte, GCI_AlphaBand, "observed"));
  }
  for (int i = 1; i <= overviews; ++i) {
    const GridGeometry coarser = GridGeometry::covering(geometry.box(), std::ldexp(geometry.cell_m, i));
    overviews_.push_back(std::make_unique<MapDataset>(map, coarser, kind));
  }
}

CPLErr MapDataset::GetGeoTransform(double* transform) {
  const GridBox box = geometry_.box();
  const double values[] = {box.min.east_m, geometry_.cell_m, 0.0, box.max.north_m, 0.0, -geometry_.cell_m};
  std::ranges::copy(values, transform);
  return CE_None;
}

const OGRSpatialReference* MapDataset::GetSpatialRef() const { return &reference_; }

const CellArray& MapDataset::block(int col, int row) {
  if (last_index_ != TileIndex{col, row}) {
    const GridGeometry under{geometry_.cell_m,
                             {geometry_.origin.col + col * kTileCells, geometry_.origin.row + row * kTileCells},
                             std::min(kTileCells, geometry_.cols - col * kTileCells),
                             std::min(kTileCells, geometry_.rows - row * kTileCells)};
    last_ = map_.read(under).cells;
    last_index_ = {col, row};
  }
  return last_;
}

bool MapDataset::is_gap(int x, int y, int width, int height) const {
  const GridGeometry window{geometry_.cell_m, {geometry_.origin.col + x, geometry_.origin.row + y}, width, height};
  const auto tiles = tiles_covering(GridGeometry::covering(window.box(), stored_cell_m_));
  return std::ranges::none_of(tiles, [this](TileIndex tile) { return stored_.contains(tile); });
}

void MapDataset::rethrow_failure() const {
  if (failure_) std::rethrow_exception(failure_);
  for (const auto& overview : overviews_) overview->rethrow_failure();
}

}  // namespace roadfix
