#include "tiles/roads/shapefile_records.hpp"

#include <cpl_string.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

#include "core/units/bytes.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kHeader = 32;

/// The first bytes of both kinds of file; nullopt of a shorter one.
std::optional<std::array<std::uint8_t, kHeader>> header_of(const std::string& path) {
  std::array<std::uint8_t, kHeader> header{};
  const FilePtr file(VSIFOpenL(path.c_str(), "rb"));
  if (!file || VSIFReadL(header.data(), 1, header.size(), file.get()) < header.size()) return std::nullopt;
  return header;
}

/// By an .shx: its length in words of 16 bits, the highest byte first; 100 bytes, and 8 for each shape.
std::optional<std::int64_t> shapes_in(const std::string& index) {
  const auto header = header_of(index);
  if (!header) return std::nullopt;
  return (2 * big_endian(Bytes(*header).subspan(24, 4)) - 100) / 8;
}

/// By a .dbf, the lowest byte first.
std::optional<std::int64_t> records_in(const std::string& table) {
  const auto header = header_of(table);
  if (!header) return std::nullopt;
  std::int64_t records = 0;
  for (std::size_t i = 7; i >= 4; --i) records = records * 256 + (*header)[i];
  return records;
}

}  // namespace

void require_as_many_records_as_shapes(GDALDataset& shapefile, const std::string& path) {
  std::map<std::string, std::string> indexes;
  std::map<std::string, std::string> tables;
  const GdalMessages messages;
  const CPLStringList files(shapefile.GetFileList(), TRUE);
  for (int i = 0; i < files.size(); ++i) {
    const std::filesystem::path name(files[i]);
    const std::string ending = lower_case(name.extension().string());
    const std::string stem = (name.parent_path() / name.stem()).string();
    if (ending == ".shx") indexes[stem] = name.string();
    if (ending == ".dbf") tables[stem] = name.string();
  }
  for (const auto& [stem, index] : indexes) {
    const auto table = tables.find(stem);
    if (table == tables.end()) continue;
    const std::optional<std::int64_t> shapes = shapes_in(index);
    const std::optional<std::int64_t> records = records_in(table->second);
    if (!shapes || !records || *shapes == *records) continue;
    throw CorruptData(
        "roads-unreadable",
        fmt::format("{}: {} holds {} shapes, but {} has {} records, so that roads would be missing. The two "
                    "are not of one save: fetch all files of the Shapefile again",
                    path, index, *shapes, table->second, *records));
  }
}

}  // namespace roadfix
