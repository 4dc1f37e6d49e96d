#include "tiles/sources/picture_tags.hpp"

#include <cpl_minixml.h>

#include <string_view>

#include "tiles/sources/gdal_session.hpp"
#include "tiles/sources/memory_file.hpp"

namespace roadfix {
namespace {

void collect(const CPLXMLNode* node, Tags& tags) {
  for (; node != nullptr; node = node->psNext) {
    const CPLXMLNode* child = node->psChild;
    if (child != nullptr && child->eType == CXT_Text) tags.emplace(node->pszValue, child->pszValue);
    collect(child, tags);
  }
}

PictureTags tags_of(GDALDataset& file) {
  const GdalMessages quiet;
  PictureTags tags;
  tags.size = {file.GetRasterXSize(), file.GetRasterYSize()};
  for (CSLConstList entry = file.GetMetadata(); entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    const auto equals = text.find('=');
    if (equals != std::string_view::npos) tags.exif.emplace(text.substr(0, equals), text.substr(equals + 1));
  }
  CSLConstList xmp = file.GetMetadata("xml:XMP");
  if (xmp != nullptr && *xmp != nullptr) tags.xmp = tags_of_xmp(*xmp);
  return tags;
}

}  // namespace

Tags tags_of_xmp(const std::string& text) {
  require_gdal();
  const GdalMessages quiet;
  const CPLXMLTreeCloser tree(CPLParseXMLString(text.c_str()));
  Tags tags;
  if (tree.get() == nullptr) return tags;
  CPLStripXMLNamespace(tree.get(), nullptr, TRUE);
  collect(tree.get(), tags);
  return tags;
}

PictureTags read_picture_tags(const std::string& path) { return tags_of(*open_dataset(path, GDAL_OF_RASTER)); }

PictureTags read_picture_tags(std::span<const std::uint8_t> bytes) {
  require_gdal();
  const GdalMessages quiet;
  const MemoryFile file(".jpg", bytes);
  // Of all that GDAL reads only this, whatever the bytes claim to be, and nothing that stands beside it.
  const char* const only_jpeg[] = {"JPEG", nullptr};
  const char* const no_siblings[] = {nullptr};
  const DatasetPtr dataset(
      GDALDataset::Open(file.path(), GDAL_OF_RASTER | GDAL_OF_READONLY, only_jpeg, nullptr, no_siblings));
  return dataset ? tags_of(*dataset) : PictureTags();
}

}  // namespace roadfix
