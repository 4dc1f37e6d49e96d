#include "tiles/imagery/picture_tags.hpp"

#include <cpl_minixml.h>

#include <string>
#include <string_view>

#include "tiles/sources/gdal_session.hpp"
#include "tiles/sources/memory_file.hpp"

namespace roadfix {
namespace {

/// An element and those around it; the nearest that declares a prefix says what it stands for.
struct Scope {
  const CPLXMLNode& element;
  const Scope* outer = nullptr;
};

constexpr std::string_view kDeclaration = "xmlns:";

std::string_view value_of(const CPLXMLNode& attribute_or_element) {
  const char* value = CPLGetXMLValue(&attribute_or_element, "", nullptr);
  return value != nullptr ? value : std::string_view();
}

/// Empty where no element declares the prefix.
std::string_view namespace_of(std::string_view prefix, const Scope& innermost) {
  for (const Scope* scope = &innermost; scope != nullptr; scope = scope->outer) {
    for (const CPLXMLNode* child = scope->element.psChild; child != nullptr; child = child->psNext) {
      const std::string_view name(child->pszValue);
      if (child->eType != CXT_Attribute || !name.starts_with(kDeclaration)) continue;
      if (name.substr(kDeclaration.size()) == prefix) return value_of(*child);
    }
  }
  return {};
}

/// Without its prefix.
std::string_view local_name(std::string_view name) { return name.substr(name.rfind(':') + 1); }

bool is_of_camera(std::string_view name, const Scope& scope) {
  std::string_view space = namespace_of(name.substr(0, name.find(':')), scope);
  if (space.ends_with('/')) space.remove_suffix(1);  // some writers leave it out
  return space == "http://pix4d.com/camera/1.0" || space == "http://ns.sensefly.com/Camera/1.0";
}

std::string tag_of(std::string_view name, const Scope& scope) {
  return (is_of_camera(name, scope) ? "Camera:" : "") + std::string(local_name(name));
}

/// Not the fields of structures: one drone tells the attitudes of several things by the same names.
void collect_properties(const Scope& description, Tags& tags) {
  for (const CPLXMLNode* child = description.element.psChild; child != nullptr; child = child->psNext) {
    const std::string_view name(child->pszValue);
    const std::string_view value = value_of(*child);
    if (value.empty() || name.starts_with(kDeclaration)) continue;
    tags.emplace(tag_of(name, {*child, &description}), value);
  }
}

void collect_descriptions(const CPLXMLNode* node, const Scope* outer, Tags& tags) {
  for (; node != nullptr; node = node->psNext) {
    if (node->eType != CXT_Element) continue;
    const Scope scope{*node, outer};
    if (local_name(node->pszValue) == "Description") {
      collect_properties(scope, tags);
    } else {
      collect_descriptions(node->psChild, &scope, tags);
    }
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
  collect_descriptions(tree.get(), nullptr, tags);
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
