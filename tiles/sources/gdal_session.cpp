#include "tiles/sources/gdal_session.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix {
namespace {

constexpr GIntBig kCacheBytes = GIntBig{384} << 20;

thread_local GdalMessages* innermost = nullptr;

/// The first bytes; fewer of a short file.
std::string begin_of(const std::string& path) {
  const FilePtr file(VSIFOpenL(path.c_str(), "rb"));
  std::string bytes(4096, '\0');
  bytes.resize(file ? VSIFReadL(bytes.data(), 1, bytes.size(), file.get()) : 0);
  return bytes;
}

/// Whether GDAL would list the folder of the file, as it does for each that it opens, only to find the list too long
/// and look for each file that may lie beside it by its name.
bool is_in_large_folder(const std::string& path) {
  static std::mutex mutex;
  static std::map<std::string, bool> known;
  const std::lock_guard lock(mutex);
  const auto [folder, is_new] = known.try_emplace(CPLGetDirname(path.c_str()));
  if (is_new) {
    const int most = std::atoi(CPLGetConfigOption("GDAL_READDIR_LIMIT_ON_OPEN", "1000"));
    const CPLStringList files(VSIReadDirEx(folder->first.c_str(), most), TRUE);
    folder->second = most > 0 && files.size() > most;
  }
  return folder->second;
}

bool is_web_page(const std::string& begin) {
  const std::string text = lower_case(begin.substr(std::min(begin.size(), begin.find_first_not_of(" \t\r\n"))));
  return text.starts_with("<!doctype html") || text.starts_with("<html");
}

/// What to do with a file that no driver opens.
std::string_view remedy(const std::string& path) {
  constexpr std::array<std::string_view, 8> kPacked{".gz", ".bz2", ".xz", ".zst", ".7z", ".rar", ".tar", ".tgz"};
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  if (std::ranges::find(kPacked, ending) != kPacked.end()) return "it is packed: unpack it first";
  if (ending == ".shp" && !std::filesystem::exists(std::filesystem::path(path).replace_extension(".shx"))) {
    return "a Shapefile is several files of one name: put its .shx, .dbf and .prj beside it";
  }
  const std::string begin = begin_of(path);
  std::error_code none;  // of a path that only GDAL knows
  if (std::filesystem::file_size(path, none) == 0) return "it holds nothing: fetch it again";
  if (is_web_page(begin)) return "it is a web page, as servers send in place of what they do not give: fetch it again";
  if (begin.starts_with('{') && begin.find("\"elements\"") != std::string::npos) {
    return "it looks like JSON of Overpass: export it as GeoJSON, or with [out:xml] into a file whose name ends in "
           ".osm";
  }
  return "gdalinfo or ogrinfo on it tells more";
}

}  // namespace

void require_gdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);  // nothing below main prints
    GDALSetCacheMax64(kCacheBytes);
    // A picture that ends early is damaged input, not a grey area.
    CPLSetConfigOption("GDAL_ERROR_ON_LIBJPEG_WARNING", "TRUE");
    CPLSetConfigOption("RAW_CHECK_FILE_SIZE", "YES");
    CPLSetConfigOption("GTIFF_IGNORE_READ_ERRORS", "NO");
    CPLSetConfigOption("OGR_INTERLEAVED_READING", "YES");
    // A progressive JPEG is unpacked as a whole, with 3 to 6 bytes a pixel, and GDAL stops at 500 MB where this is not
    // set. The largest JPEG takes 26 GB; whoever wants less says so in the environment, where libjpeg looks too.
    if (CPLGetConfigOption("JPEGMEM", nullptr) == nullptr) CPLSetConfigOption("JPEGMEM", "26000M");
  });
}

void keep_in_cache(double bytes) {
  const double largest = static_cast<double>(CPLGetUsablePhysicalRAM()) / 4.0;
  const auto wanted = static_cast<GIntBig>(std::min(bytes, largest));
  if (wanted > GDALGetCacheMax64()) GDALSetCacheMax64(wanted);
}

GdalMessages::GdalMessages() : outer_(innermost) {
  innermost = this;
  CPLPushErrorHandler(&GdalMessages::collect);
}

GdalMessages::~GdalMessages() {
  CPLPopErrorHandler();
  innermost = outer_;
}

void CPL_STDCALL GdalMessages::collect(CPLErr severity, CPLErrorNum, const char* message) {
  if (severity < CE_Failure) return;
  for (GdalMessages* m = innermost; m != nullptr; m = m->outer_) m->last_ = message;
}

std::string GdalMessages::text() const { return last_.empty() ? std::string(kNone) : last_; }

DatasetPtr try_to_open(const std::string& path, unsigned flags, const char* const* open_options) {
  require_gdal();
  std::optional<CPLConfigOptionSetter> without_list;
  if (is_in_large_folder(path)) without_list.emplace("GDAL_DISABLE_READDIR_ON_OPEN", "TRUE", true);
  return DatasetPtr(GDALDataset::Open(path.c_str(), flags | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                                      open_options, nullptr));
}

DatasetPtr open_dataset(const std::string& path, unsigned flags, const char* const* open_options) {
  const GdalMessages messages;
  DatasetPtr dataset = try_to_open(path, flags, open_options);
  if (dataset) return dataset;
  VSIStatBufL stat;
  errno = 0;
  if (VSIStatL(path.c_str(), &stat) != 0 && errno != EACCES) {
    const bool with_layer = path.find("|layername=") != std::string::npos;  // as QGIS writes it
    throw NotFound("file-not-found",
                   fmt::format("{}: no such file; {}", path,
                               with_layer ? "name the layer with --layer, not here" : "check its name"));
  }
  const std::string said = messages.text();
  throw InvalidInput("source-unreadable", fmt::format("{}: cannot be opened ({}); {}", path, said, remedy(path)));
}

std::string_view remedy_of_pixels(std::string_view reason) {
  const auto says = [&](std::string_view words) { return reason.find(words) != std::string_view::npos; };
  if (says("No such file")) {
    return "an image that it is made of is missing: put it back, or make the file anew from those that are there";
  }
  if (says("pixel function") || says("Python code")) {
    return "a function computes them which is not known here or not trusted: make a GeoTIFF of them where it is "
           "(gdal_translate)";
  }
  if (says("JPEGMEM") || says("Backing store")) {
    return "a progressive JPEG is unpacked as a whole, and this one takes more memory than is allowed: allow it with "
           "the environment variable JPEGMEM, for example JPEGMEM=8000M";
  }
  return "the file is cut off or damaged: fetch it again and repeat the command";
}

OGRSpatialReference utm_reference(UtmZone zone) {
  require_gdal();
  OGRSpatialReference reference;
  reference.importFromEPSG(zone.epsg());
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

OGRSpatialReference wgs84_reference() {
  require_gdal();
  OGRSpatialReference reference;
  reference.importFromEPSG(4326);
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

OGRSpatialReference parse_crs(const std::string& text) {
  require_gdal();
  const GdalMessages messages;
  OGRSpatialReference reference;
  if (reference.SetFromUserInput(text.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
      OGRERR_NONE) {
    throw InvalidInput("crs-unknown",
                       fmt::format("'{}' is not a coordinate reference system ({}): write for example EPSG:32637", text,
                                   messages.text()));
  }
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

std::string crs_name(const OGRSpatialReference& reference) {
  const char* authority = reference.GetAuthorityName(nullptr);
  const char* code = reference.GetAuthorityCode(nullptr);
  if (authority != nullptr && code != nullptr) return fmt::format("{}:{}", authority, code);
  const char* name = reference.GetName();
  return name != nullptr ? name : "unnamed";
}

bool lies_on_earth(const OGRSpatialReference& reference) {
  return reference.IsLocal() == FALSE && crs_name(reference) != "Undefined geographic SRS";
}

std::string not_on_earth(const OGRSpatialReference* reference) {
  return reference == nullptr ? "" : fmt::format(" of the Earth (it names '{}')", crs_name(*reference));
}

bool on_old_ellipsoid(const OGRSpatialReference& reference) {
  constexpr double kWgs84M = 6378137.0;  // GRS 80 and the sphere of web maps, too
  constexpr double kSameM = 0.01;  // a survey's own datum may have an ellipsoid that is only 3 m larger (Xian 1980)
  OGRErr outcome = OGRERR_NONE;
  const double axis_m = reference.GetSemiMajor(&outcome);
  return outcome == OGRERR_NONE && std::abs(axis_m - kWgs84M) >= kSameM;
}

void require_known_datum(const OGRSpatialReference& from, const OGRSpatialReference& to, const std::string& path) {
  if (!on_old_ellipsoid(from)) return;
  const GdalMessages messages;
  OGRCoordinateTransformationOptions options;
  options.SetBallparkAllowed(false);
  if (TransformationPtr(OGRCreateCoordinateTransformation(&from, &to, options))) return;
  const char* ellipsoid = from.GetAttrValue("SPHEROID");
  throw InvalidInput(
      "datum-unknown",
      fmt::format("{}: its reference system {} does not relate its ellipsoid ({}) to WGS 84, so the roads could be "
                  "hundreds of metres off: {}, for example EPSG:23037 (ED50, zone 37)",
                  path, crs_name(from), ellipsoid != nullptr ? ellipsoid : "unnamed", kGiveRightCrs));
}

TransformationPtr transformation(const OGRSpatialReference& from, const OGRSpatialReference& to,
                                 const std::string& path) {
  const GdalMessages messages;
  TransformationPtr result(OGRCreateCoordinateTransformation(&from, &to));
  if (!result) {
    throw InvalidInput("crs-not-transformable",
                       fmt::format("{}: no way from its reference system {} to {} ({}); if it is wrong, {}", path,
                                   crs_name(from), crs_name(to), messages.text(), kGiveRightCrs));
  }
  require_known_datum(from, to, path);
  return result;
}

}  // namespace roadfix
