#include "tiles/sources/source_files.hpp"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "tiles/sources/exported_roads.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> kImageEndings{".tif", ".tiff", ".jpg", ".jpeg", ".png",
                                                        ".jp2", ".img",  ".vrt", ".webp"};
constexpr std::array<std::string_view, 14> kVectorEndings{
    ".shp",  ".shz",  ".geojson", ".geojsonl", ".geojsons", ".geojsonseq", ".ndjson",
    ".json", ".gpkg", ".pbf",     ".osm",      ".mvt",      ".fgb",        ".gdb"};
/// Of formats that GDAL reads too, but that are as often something else (a legend, a log, a preview): a folder's user
/// hears of them and can name them.
constexpr std::array<std::string_view, 18> kOtherEndings{".asc",     ".bil",  ".ecw", ".j2k", ".jpx",    ".kap",
                                                         ".mbtiles", ".nitf", ".ntf", ".sid", ".dxf",    ".gml",
                                                         ".gpx",     ".kml",  ".kmz", ".mif", ".sqlite", ".tab"};

std::string ending_of(const fs::path& path) { return lower_case(path.extension().string()); }

template <typename Endings>
bool one_of(const Endings& endings, std::string_view ending) {
  return std::ranges::find(endings, ending) != endings.end();
}

bool is_map(GDALDataset& raster) { return EQUAL(raster.GetDriverName(), "GPKG") && is_called_as_maps_are(raster); }

bool is_exported(const std::string& image) {
  const GdalMessages messages;
  const DatasetPtr raster(GDALDataset::Open(image.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  return raster && holds_exported_roads(*raster);
}

/// "layer 'roads' of city.gpkg" for each that has geometries.
std::vector<std::string> layers_of(const std::string& path) {
  std::vector<std::string> layers;
  const GdalMessages messages;
  const DatasetPtr vectors(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!vectors) return layers;
  for (OGRLayer* layer : vectors->GetLayers()) {
    if (layer->GetGeomType() != wkbNone) layers.push_back(fmt::format("layer '{}' of {}", layer->GetName(), path));
  }
  return layers;
}

/// A map of roadfix, or a picture in a GeoPackage: no file of roads, though its name could be one's.
bool is_geopackage_of_pixels(const std::string& path) {
  if (ending_of(path) != ".gpkg" || !layers_of(path).empty()) return false;
  const GdalMessages messages;
  return DatasetPtr(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY)) != nullptr;
}

/// By its first bytes: to open a GeoJSON takes as long as to read all of it.
bool seems_to_hold_vectors(const std::string& path) {
  const GdalMessages messages;
  return GDALIdentifyDriverEx(path.c_str(), GDAL_OF_VECTOR, nullptr, nullptr) != nullptr;
}

/// A description of layers, not of images.
bool is_vector_vrt(const std::string& path) { return ending_of(path) == ".vrt" && seems_to_hold_vectors(path); }

/// What programs leave beside roads: settings, descriptions, answers of Overpass.
bool is_other_json(const std::string& path) {
  constexpr std::array<std::string_view, 2> kEndings{".json", ".ndjson"};
  return one_of(kEndings, ending_of(path)) && !seems_to_hold_vectors(path);
}

struct FileKind {
  SourceKind kind = SourceKind::kRoadVectors;
  bool is_map = false;
};

/// What a file is unless the user says it: rasters of roads that roadfix wrote are roads, all others imagery. A file
/// that neither opens as raster nor as vectors is reported by name.
FileKind kind_of(const std::string& path, const std::string& layer) {
  constexpr FileKind kVectors;
  if (one_of(kVectorEndings, ending_of(path)) && ending_of(path) != ".gpkg") return kVectors;
  if (is_vector_vrt(path)) return kVectors;
  if (!layer.empty() && !layers_of(path).empty()) return kVectors;
  {
    const GdalMessages messages;
    const DatasetPtr raster(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    if (raster && is_map(*raster)) return {SourceKind::kRoadRaster, true};
    if (raster) return {holds_exported_roads(*raster) ? SourceKind::kRoadRaster : SourceKind::kImagery};
  }
  if (one_of(kImageEndings, ending_of(path))) {
    open_dataset(path, GDAL_OF_RASTER);  // says why not
  }
  return kVectors;
}

/// The name that "." or "../" stand for, too.
std::string name_of_folder(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

/// An ESRI file geodatabase is a folder, which GDAL opens as one file.
bool is_geodatabase(const fs::path& path) { return ending_of(path) == ".gdb"; }

std::vector<std::string> files_in_folder(const fs::path& folder) {
  std::vector<std::string> files;
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator(); ++entry) {
    const bool geodatabase = is_geodatabase(entry->path()) && entry->is_directory();
    if (geodatabase) entry.disable_recursion_pending();
    if (geodatabase || entry->is_regular_file()) files.push_back(entry->path().string());
  }
  return files;
}

/// As GDAL opens them.
std::vector<std::string> files_in_zip(const std::string& archive) {
  const GdalMessages messages;
  const std::string inside = "/vsizip/" + archive;
  const CPLStringList names(VSIReadDirRecursive(inside.c_str()));
  if (names.empty()) {
    throw InvalidInput("source-unreadable",
                       fmt::format("{}: cannot be opened as a ZIP archive; fetch it again, or unpack it", archive));
  }
  std::vector<std::string> files;
  for (int i = 0; i < names.size(); ++i) {
    const fs::path name = inside + "/" + names[i];
    const bool folder = !name.has_filename();
    if (!folder || is_geodatabase(name.parent_path())) files.push_back((folder ? name.parent_path() : name).string());
  }
  return files;
}

/// Taken for imagery, the probabilities of a map would be looked through for roads once more.
bool are_exported(const std::vector<std::string>& images, const std::string& location) {
  const auto other = std::ranges::find_if_not(images, is_exported);
  if (other == images.end()) return true;
  const auto exported = std::ranges::find_if(images, is_exported);
  if (exported == images.end()) return false;
  throw InvalidInput("imagery-mixed",
                     fmt::format("{}: {} holds roads that roadfix wrote, {} does not. Ingest each kind by itself, or "
                                 "say with --as what all of them are",
                                 location, *exported, *other));
}

/// One source of all images, or where there are none of all vector files.
SourceFiles source_of_all(const std::vector<std::string>& files, const std::string& location,
                          std::optional<SourceContent> content) {
  SourceFiles result;
  std::vector<std::string> images;
  std::vector<std::string> vectors;
  std::vector<std::string> others;
  for (const std::string& file : files) {
    if (fs::path(file).filename().string().starts_with(".")) continue;  // "._roads.shp" of a Mac is no Shapefile
    const std::string ending = ending_of(file);
    if (is_vector_vrt(file) || is_geopackage_of_pixels(file) || is_other_json(file)) {
      others.push_back(file);  // a VRT is of the layers beside it, mostly
      continue;
    }
    if (one_of(kImageEndings, ending)) images.push_back(file);
    if (one_of(kVectorEndings, ending)) vectors.push_back(file);
    if (one_of(kOtherEndings, ending)) others.push_back(file);
  }
  if (images.empty() && vectors.empty()) {
    throw InvalidInput(
        "source-empty",
        fmt::format("{}: holds neither images nor vector files{}", location,
                    others.empty() ? "" : fmt::format("; to ingest {}, name it itself", others.front())));
  }
  const bool roads = content == SourceContent::kRoads || (!content && are_exported(images, location));
  result.kind = roads ? SourceKind::kRoadRaster : SourceKind::kImagery;
  result.paths = std::move(images);
  if (result.paths.empty()) {
    result.kind = SourceKind::kRoadVectors;
    result.paths = std::move(vectors);
  } else {
    result.left_out = std::move(vectors);
  }
  std::ranges::move(others, std::back_inserter(result.left_out));
  std::ranges::sort(result.paths);
  std::ranges::sort(result.left_out);
  return result;
}

/// "liechtenstein" of "liechtenstein.osm.pbf" and of "liechtenstein.shp.zip".
std::string name_of_file(const fs::path& path) {
  const fs::path stem = path.stem();
  const std::string inner = ending_of(stem);
  return inner == ".osm" || inner == ".shp" ? stem.stem().string() : stem.string();
}

}  // namespace

SourceFiles find_source(const std::string& argument, std::optional<SourceContent> content, const std::string& layer) {
  require_gdal();
  const fs::path path = fs::path(argument).has_filename() ? fs::path(argument) : fs::path(argument).parent_path();
  SourceFiles result;
  if (fs::is_directory(path) && !is_geodatabase(path)) {
    result = source_of_all(files_in_folder(path), path.string(), content);
    result.name = name_of_folder(path);
  } else if (ending_of(path) == ".zip" && fs::exists(path)) {
    result = source_of_all(files_in_zip(argument), argument, content);
    result.name = name_of_file(path);
  } else {
    result.paths = {argument};
    const FileKind kind = kind_of(argument, layer);
    result.kind = kind.kind;
    result.is_map = kind.is_map;
    if (result.kind == SourceKind::kRoadVectors) {
      if (!seems_to_hold_vectors(argument)) open_dataset(argument, GDAL_OF_VECTOR);  // says why not
    } else {
      result.left_out = layers_of(argument);
      if (content == SourceContent::kRoads) result.kind = SourceKind::kRoadRaster;
      if (content == SourceContent::kImagery) result.kind = SourceKind::kImagery;
    }
    result.name = name_of_file(path);
  }
  if (content == SourceContent::kImagery && result.kind == SourceKind::kRoadVectors) {
    throw InvalidInput("source-not-imagery", fmt::format("{}: holds vectors, not pixels; give it as roads", argument));
  }
  result.location = argument;
  return result;
}

}  // namespace roadfix
