#include "tiles/export/map_export.hpp"

#include <fmt/format.h>

#include <fstream>
#include <ios>
#include <string>
#include <string_view>
#include <system_error>

#include "core/geodesy/shown_ground.hpp"
#include "core/units/error.hpp"
#include "core/units/file_beside.hpp"
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
      for (const char* option :
           {"COMPRESS=DEFLATE", "RESAMPLING=AVERAGE", "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS"}) {
        options.AddString(option);
      }
      return {"COG", PixelKind::kProbability, options};
    case ExportFormat::kGeoTiff:
      for (const char* option : {"COMPRESS=DEFLATE", "TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256",
                                 "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS"}) {
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
      break;
  }
  options.SetNameValue("TILE_FORMAT", "PNG");
  options.SetNameValue("NAME", "road probability");
  options.SetNameValue("DESCRIPTION", description_of(info).c_str());
  return {"MBTiles", PixelKind::kPicture, options};
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

struct Monitor {
  MapDataset& source;
  const OnProgress& progress;
  const std::stop_token& stop;
  double share_before = 0.0;  ///< of the whole work
  double share = 1.0;
};

/// GDAL is C below: no exception may leave.
int on_progress(double share, const char*, void* monitor) {
  const Monitor& now = *static_cast<const Monitor*>(monitor);
  try {
    if (now.progress) now.progress(static_cast<std::int64_t>((now.share_before + share * now.share) * 1000.0), 1000);
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

/// False where GDAL failed or was stopped.
bool written_by(GDALDriver& driver, const Driver& target, const fs::path& path, Monitor monitor) {
  constexpr double kCopyShare = 0.7;  // of the time, where zooms follow
  const bool has_zooms = target.name == std::string_view("MBTiles");
  if (has_zooms) monitor.share = kCopyShare;
  const DatasetPtr written(driver.CreateCopy(path.c_str(), &monitor.source, FALSE,
                                             const_cast<char**>(target.options.List()), on_progress, &monitor));
  if (written == nullptr || !has_zooms) return written != nullptr;
  monitor.share_before = kCopyShare;
  monitor.share = 1.0 - kCopyShare;
  return add_zooms(*written, on_progress, &monitor);
}

void copy(const Driver& kind, const Picture& picture, const Monitor& monitor) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(kind.name);
  if (driver == nullptr) {
    throw IoFailure("export-failed", fmt::format("this GDAL has no {} driver. Choose another format", kind.name));
  }
  const GdalMessages messages;
  CPLErrorReset();
  const bool copied = written_by(*driver, kind, picture.unfinished(), monitor);
  monitor.source.rethrow_failure();
  if (monitor.stop.stop_requested()) throw Interrupted("work-stopped", "the export was stopped; nothing was written");
  if (!copied || CPLGetLastErrorType() >= CE_Failure) {  // of MBTiles, the driver itself gets over some
    throw IoFailure("export-failed",
                    fmt::format("{}: it cannot be written ({}). Check that the folder exists, may be written to and "
                                "has room",
                                picture.target().string(), messages.text()));
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
  try {
    MapDataset source(map, geometry, driver.pixels);
    Picture picture(target);
    copy(driver, picture, {source, progress, stop});
    if (options.format == ExportFormat::kMbTiles) {
      complete_metadata(picture.unfinished(), map.info());
      sqlite::remove_logs(target);
    }
    if (options.format == ExportFormat::kPng && !picture.is_whole_png()) {
      throw IoFailure("export-failed",
                      fmt::format("{}: its end cannot be written. Check that the disk has room", target.string()));
    }
    picture.finish();
  } catch (const fs::filesystem_error& error) {
    throw IoFailure("export-failed", fmt::format("{}: {}", target.string(), error.code().message()));
  }
}

}  // namespace roadfix
