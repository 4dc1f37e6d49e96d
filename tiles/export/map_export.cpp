#include "tiles/export/map_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <ios>
#include <string>
#include <string_view>
#include <system_error>

#include "core/geodesy/shown_ground.hpp"
#include "core/units/error.hpp"
#include "core/units/file_beside.hpp"
#include "tiles/export/export_failures.hpp"
#include "tiles/export/map_dataset.hpp"
#include "tiles/export/mbtiles.hpp"
#include "tiles/export/side_files.hpp"
#include "tiles/sources/gdal_session.hpp"
#include "tiles/store/sqlite.hpp"
#include "tiles/store/tile_matrix.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;

struct Driver {
  const char* name;
  PixelKind pixels;
  CPLStringList options;  ///< of the driver
};

Driver driver_of(ExportFormat format, const MapInfo& info) {
  CPLStringList options;
  if (format == ExportFormat::kPng) {
    options.SetNameValue("WORLDFILE", "YES");
    options.SetNameValue("WRITE_METADATA_AS_TEXT", "YES");
    options.SetNameValue("DESCRIPTION", description_of(info).c_str());
    if (const std::string credits = credits_of(info); !credits.empty()) {
      options.SetNameValue("COPYRIGHT", credits.c_str());
    }
    return {"PNG", PixelKind::kPicture, options};
  }
  for (const char* option : {"COMPRESS=DEFLATE", "SPARSE_OK=TRUE", "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS"}) {
    options.AddString(option);
  }
  if (format == ExportFormat::kCog) return {"COG", PixelKind::kProbability, options};
  for (const char* option : {"TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256"}) options.AddString(option);
  return {"GTiff", PixelKind::kProbability, options};
}

GridGeometry geometry_of(const MapReader& map, const ExportOptions& options) {
  const MapInfo& info = map.info();
  if (info.extent.empty()) {
    throw InvalidInput("map-has-no-cells", "the map has no observed cells to export. Ingest a source first");
  }
  const double cell_m = options.cell_m.value_or(info.settings.cell_m);
  map.read({cell_m, {0, 0}, 0, 0});  // says so where the map has no such cells
  const GridGeometry whole = GridGeometry::covering(info.extent, cell_m);
  if (!options.box) return whole;
  if (!options.box->empty()) {
    const auto region = whole.intersection(GridGeometry::covering(*options.box, cell_m));
    if (region) return *region;
  }
  throw InvalidInput("region-outside-map",
                     fmt::format("the region to export does not touch the ground of the map, {}: check the region",
                                 shown_ground(info.settings.zone, info.extent)));
}

/// Of a COG, each half as large, until one is at most a tile of 512 x 512.
int overviews_of(const GridGeometry& geometry) {
  constexpr int kSmallest = 512;
  int count = 0;
  for (int size = std::max(geometry.cols, geometry.rows); size > kSmallest; size = (size + 1) / 2) ++count;
  while (std::ldexp(geometry.cell_m, count) > cell_of_zoom(0)) --count;
  return count;
}

/// Widened to whole cells of the coarsest of so many overviews.
GridGeometry widened(const GridGeometry& geometry, int overviews) {
  const double coarsest_m = std::ldexp(geometry.cell_m, overviews);
  return GridGeometry::covering(GridGeometry::covering(geometry.box(), coarsest_m).box(), geometry.cell_m);
}

struct Monitor {
  MapDataset& source;
  const OnProgress& progress;
  const std::stop_token& stop;
};

/// GDAL is C below: no exception may leave.
int on_progress(double share, const char*, void* monitor) {
  const Monitor& now = *static_cast<const Monitor*>(monitor);
  try {
    if (now.progress) now.progress(static_cast<std::int64_t>(share * 1000.0), 1000);
  } catch (...) {
    now.source.keep_failure();
    return FALSE;
  }
  return now.stop.stop_requested() ? FALSE : TRUE;
}

bool ends_with(const fs::path& file, std::string_view end) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(end.size(), '\0');
  in.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  return in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) && bytes == end;
}

/// A picture, and what of the files beside it says where it lies.
class Picture {
 public:
  explicit Picture(const fs::path& target)
      : picture_(target),
        world_(common_world_file(target), common_world_file(unfinished())),
        reference_(target.string() + kReference, unfinished().string() + kReference) {}
  /// A copy that fails leaves more.
  ~Picture() {
    std::error_code ignored;
    for (const char* suffix : {"-journal", ".ovr.tmp", ".msk.ovr.tmp"}) {
      fs::remove(unfinished().string() + suffix, ignored);
    }
  }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  const fs::path& target() const { return picture_.target(); }
  const fs::path& unfinished() const { return picture_.unfinished(); }
  /// GDAL's driver does not notice when the last bytes of a PNG or of the files beside it find no room.
  bool is_whole_png() const {
    constexpr std::string_view kLastChunk("\0\0\0\0IEND\xae\x42\x60\x82", 12);
    return ends_with(unfinished(), kLastChunk) && ends_with(world_.unfinished(), "\n") &&
           ends_with(reference_.unfinished(), "</PAMDataset>\n");
  }
  void finish() {
    picture_.finish();
    remove_side_files(picture_.target());
    for (FileBeside* beside : {&world_, &reference_}) {
      if (fs::exists(beside->unfinished())) beside->finish();
    }
  }

 private:
  static constexpr const char* kReference = ".aux.xml";
  FileBeside picture_;
  FileBeside world_;
  FileBeside reference_;
};

void copy(const Driver& kind, const Picture& picture, const Monitor& monitor) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(kind.name);
  if (driver == nullptr) {
    throw IoFailure("export-failed", fmt::format("this GDAL has no {} driver. Choose another format", kind.name));
  }
  const GdalMessages messages;
  CPLErrorReset();
  const bool copied = DatasetPtr(driver->CreateCopy(picture.unfinished().c_str(), &monitor.source, FALSE,
                                                    const_cast<char**>(kind.options.List()), on_progress,
                                                    const_cast<Monitor*>(&monitor))) != nullptr;  // and closed
  monitor.source.rethrow_failure();
  if (monitor.stop.stop_requested()) throw export_stopped();
  if (!copied || CPLGetLastErrorType() >= CE_Failure) {
    throw cannot_be_written(picture.target(), messages.text());
  }
}

void copy_with_gdal(const MapReader& map, const GridGeometry& geometry, ExportFormat format, const Picture& picture,
                    const OnProgress& progress, const std::stop_token& stop) {
  constexpr std::int64_t kLargestPicture = std::int64_t{1} << 29;
  if (format == ExportFormat::kPng && std::int64_t{geometry.cols} * geometry.rows > kLargestPicture) {
    throw LimitExceeded("picture-too-large",
                        fmt::format("{} x {} pixels are too many for a PNG. Export a region or coarser cells",
                                    geometry.cols, geometry.rows));
  }
  require_gdal();
  const Driver driver = driver_of(format, map.info());
  const int overviews = format == ExportFormat::kCog ? overviews_of(geometry) : 0;
  MapDataset source(map, widened(geometry, overviews), driver.pixels, overviews);
  copy(driver, picture, {source, progress, stop});
  if (format == ExportFormat::kPng && !picture.is_whole_png()) {
    throw IoFailure("export-failed", fmt::format("{}: its end cannot be written. Check that the disk has room",
                                                 picture.target().string()));
  }
}

}  // namespace

void export_map(const MapReader& map, const fs::path& target, const ExportOptions& options, const OnProgress& progress,
                std::stop_token stop) {
  const GridGeometry geometry = geometry_of(map, options);
  try {
    Picture picture(target);
    if (options.format == ExportFormat::kMbTiles) {
      write_mbtiles(map, geometry, picture.unfinished(), target, progress, stop);
      sqlite::remove_logs(target);
    } else {
      copy_with_gdal(map, geometry, options.format, picture, progress, stop);
    }
    picture.finish();
  } catch (const fs::filesystem_error& error) {
    throw IoFailure("export-failed", fmt::format("{}: {}", target.string(), error.code().message()));
  }
}

}  // namespace roadfix
