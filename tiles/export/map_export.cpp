#include "tiles/export/map_export.hpp"

#include <fmt/format.h>

#include <fstream>
#include <ios>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include "core/units/error.hpp"
#include "tiles/export/map_dataset.hpp"
#include "tiles/export/mbtiles.hpp"
#include "tiles/export/one_side.hpp"
#include "tiles/export/side_files.hpp"
#include "tiles/sources/gdal_session.hpp"
#include "tiles/store/sqlite.hpp"

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
  switch (format) {
    case ExportFormat::kCog:
      for (const char* option : {"COMPRESS=DEFLATE", "RESAMPLING=AVERAGE", "BIGTIFF=IF_SAFER"}) {
        options.AddString(option);
      }
      return {"COG", PixelKind::kProbability, options};
    case ExportFormat::kGeoTiff:
      for (const char* option :
           {"COMPRESS=DEFLATE", "TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256", "BIGTIFF=IF_SAFER"}) {
        options.AddString(option);
      }
      return {"GTiff", PixelKind::kProbability, options};
    case ExportFormat::kPng:
      options.SetNameValue("WORLDFILE", "YES");
      options.SetNameValue("WRITE_METADATA_AS_TEXT", "YES");
      options.SetNameValue("DESCRIPTION", description_of(info).c_str());
      if (const std::string credits = credits_of(info); !credits.empty()) {
        options.SetNameValue("COPYRIGHT", credits.c_str());
      }
      return {"PNG", PixelKind::kPicture, options};
    case ExportFormat::kMbTiles:
      options.SetNameValue("TILE_FORMAT", "PNG");
      options.SetNameValue("NAME", "road probability");
      options.SetNameValue("DESCRIPTION", description_of(info).c_str());
      return {"MBTiles", PixelKind::kPicture, options};
  }
  throw InvalidInput("format-unknown", "no such export format");
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
                     "the region to export does not touch the observed part of the map. roadfix "
                     "info shows where that is");
}

struct Monitor {
  const OnProgress& progress;
  const std::stop_token& stop;
  double share_before = 0.0;  ///< of the whole work
  double share = 1.0;
};

int on_progress(double share, const char*, void* monitor) {
  const Monitor& now = *static_cast<const Monitor*>(monitor);
  if (now.progress) now.progress(static_cast<std::int64_t>((now.share_before + share * now.share) * 1000.0), 1000);
  return now.stop.stop_requested() ? FALSE : TRUE;
}

/// What a copy leaves beside its target when it fails, and side files of a driver.
void remove_unfinished(const fs::path& unfinished) {
  std::error_code ignored;
  for (const char* suffix : {"", ".aux.xml", "-journal", ".ovr.tmp", ".msk.ovr.tmp"})
    fs::remove(unfinished.string() + suffix, ignored);
  fs::remove(common_world_file(unfinished), ignored);
}

bool ends_with(const fs::path& file, std::string_view end) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(end.size(), '\0');
  in.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  return in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) && bytes == end;
}

/// GDAL's driver does not notice when the last bytes of a picture or of the files that say where it lies find no room.
void require_whole_picture(const fs::path& picture, const fs::path& world, const fs::path& reference) {
  constexpr std::string_view kLastChunk("\0\0\0\0IEND\xae\x42\x60\x82", 12);
  if (ends_with(picture, kLastChunk) && ends_with(world, "\n") && ends_with(reference, "</PAMDataset>\n")) return;
  throw IoFailure("export-failed",
                  fmt::format("{}: its end cannot be written. Check that the disk has room", picture.string()));
}

/// False where GDAL failed or was stopped.
bool written_by(GDALDriver& driver, MapDataset& source, const Driver& target, const fs::path& path, Monitor monitor) {
  constexpr double kCopyShare = 0.7;  // of the time, where zooms follow
  const bool has_zooms = target.name == std::string_view("MBTiles");
  if (has_zooms) monitor.share = kCopyShare;
  const std::unique_ptr<GDALDataset> written(driver.CreateCopy(
      path.c_str(), &source, FALSE, const_cast<char**>(target.options.List()), on_progress, &monitor));
  if (written == nullptr || !has_zooms) return written != nullptr;
  monitor.share_before = kCopyShare;
  monitor.share = 1.0 - kCopyShare;
  return add_zooms(*written, on_progress, &monitor);
}

void copy(MapDataset& source, const Driver& target, const fs::path& path, const Monitor& monitor) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(target.name);
  if (driver == nullptr) {
    throw IoFailure("export-failed", fmt::format("this GDAL has no {} driver. Choose another format", target.name));
  }
  CPLErrorReset();
  // The error is reported by exception, not printed by GDAL.
  CPLPushErrorHandler(CPLQuietErrorHandler);
  const bool copied = written_by(*driver, source, target, path, monitor);
  CPLPopErrorHandler();
  source.rethrow_failure();
  if (monitor.stop.stop_requested()) throw Interrupted("export-stopped", "the export was stopped; nothing was written");
  if (!copied || CPLGetLastErrorType() >= CE_Failure) {
    throw IoFailure("export-failed",
                    fmt::format("{}: it cannot be written ({}). Check that the folder exists, may be written to and "
                                "has room",
                                path.string(), CPLGetLastErrorMsg()));
  }
}

}  // namespace

void export_map(const MapReader& map, const fs::path& target, const ExportOptions& options, const OnProgress& progress,
                std::stop_token stop) {
  constexpr std::int64_t kLargestPicture = std::int64_t{1} << 29;
  require_gdal();
  const Driver driver = driver_of(options.format, map.info());
  const GridGeometry geometry = geometry_of(map, options);
  if (options.format == ExportFormat::kPng && std::int64_t{geometry.cols} * geometry.rows > kLargestPicture) {
    throw LimitExceeded("picture-too-large",
                        fmt::format("{} x {} pixels are too many for a PNG. Export a region or coarser cells",
                                    geometry.cols, geometry.rows));
  }
  if (options.format == ExportFormat::kMbTiles) require_one_side(map.info().settings.zone, geometry);
  // The name ends like the target: drivers look at the extension.
  const fs::path unfinished = target.parent_path() / ("unfinished-" + target.filename().string());
  remove_unfinished(unfinished);
  try {
    MapDataset source(map, geometry, driver.pixels);
    copy(source, driver, unfinished, {progress, stop});
    const fs::path world = common_world_file(unfinished);
    const fs::path reference = unfinished.string() + ".aux.xml";
    if (options.format == ExportFormat::kMbTiles) complete_metadata(unfinished, map.info());
    if (options.format == ExportFormat::kPng) require_whole_picture(unfinished, world, reference);
    if (options.format == ExportFormat::kMbTiles) sqlite::remove_logs(target);
    fs::rename(unfinished, target);
    remove_side_files(target);
    if (fs::exists(world)) fs::rename(world, common_world_file(target));
    if (fs::exists(reference)) fs::rename(reference, target.string() + ".aux.xml");
    remove_unfinished(unfinished);
  } catch (const fs::filesystem_error& error) {
    remove_unfinished(unfinished);
    throw IoFailure("export-failed", fmt::format("{}: {}", target.string(), error.code().message()));
  } catch (...) {
    remove_unfinished(unfinished);
    throw;
  }
}

}  // namespace roadfix
