#include "tiles/sources/fingerprint.hpp"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <string_view>

#include "core/units/error.hpp"
#include "core/units/fnv.hpp"
#include "core/units/text.hpp"
#include "tiles/sources/aux_xml.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

constexpr vsi_l_offset kWholeBytes = vsi_l_offset{8} << 20;
constexpr std::size_t kEndBytes = std::size_t{1} << 20;

void add_content(Fnv1a64& hash, const std::string& path, vsi_l_offset size) {
  const FilePtr file(VSIFOpenL(path.c_str(), "rb"));
  if (!file) throw IoFailure("source-unreadable", fmt::format("{}: cannot be read", path));
  const bool whole = size <= kWholeBytes;
  std::string bytes(whole ? static_cast<std::size_t>(size) : kEndBytes, '\0');
  bytes.resize(VSIFReadL(bytes.data(), 1, bytes.size(), file.get()));
  hash.add(bytes);
  if (whole) return;
  VSIFSeekL(file.get(), size - kEndBytes, SEEK_SET);
  bytes.resize(kEndBytes);
  bytes.resize(VSIFReadL(bytes.data(), 1, bytes.size(), file.get()));
  hash.add(bytes);
}

/// Formats that are one file: GDAL would read all of it, some hundred megabytes, to say so.
bool is_alone(const std::string& path) {
  constexpr std::array<std::string_view, 5> kEndings{".geojson", ".json", ".osm", ".pbf", ".mvt"};
  return std::ranges::find(kEndings, lower_case(std::filesystem::path(path).extension().string())) != kEndings.end();
}

/// The file and what is read with it: world files and their .prj, .aux.xml, the parts of a Shapefile, the images of a
/// VRT, and of the VRTs among them; what was written into a GeoPackage that another program has open.
void add_with_side_files(const std::string& path, std::set<std::string>& files) {
  if (!files.insert(path).second) return;
  files.insert(CPLResetExtension(path.c_str(), "prj"));
  files.insert(CPLResetExtension(path.c_str(), "PRJ"));
  if (is_alone(path)) return;
  files.insert(path + "-wal");
  const GdalMessages messages;
  const DatasetPtr dataset = try_to_open(path, GDAL_OF_RASTER | GDAL_OF_VECTOR);
  if (!dataset) return;
  const CPLStringList list(dataset->GetFileList(), TRUE);
  for (int i = 0; i < list.size(); ++i) {
    const std::string file = list[i];
    if (lower_case(std::filesystem::path(file).extension().string()) == ".vrt") {
      add_with_side_files(file, files);
    } else {
      files.insert(file);
    }
  }
}

}  // namespace

std::string fingerprint(const std::vector<std::string>& paths, const std::string& settings) {
  require_gdal();
  Fnv1a64 hash;
  hash.add(settings);
  for (const std::string& path : paths) {
    std::set<std::string> files;
    add_with_side_files(path, files);
    for (const std::string& file : files) {
      VSIStatBufL stat;
      if (VSIStatL(file.c_str(), &stat) != 0 || (VSI_ISREG(stat.st_mode) && stat.st_size == 0)) continue;
      if (is_aux_xml(file)) {
        hash.add(told_by_aux_xml(file));
        continue;
      }
      hash.add(std::filesystem::path(file).filename().string());
      const bool regular = VSI_ISREG(stat.st_mode) != 0;
      const bool whole = regular && static_cast<vsi_l_offset>(stat.st_size) <= kWholeBytes;
      hash.add(fmt::format("{};{};", stat.st_size, whole ? 0 : stat.st_mtime));  // a copy has another time
      if (regular) add_content(hash, file, static_cast<vsi_l_offset>(stat.st_size));
    }
  }
  return hash.text();
}

}  // namespace roadfix
