#include "tiles/sources/aux_xml.hpp"

#include <cpl_minixml.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/units/text.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

constexpr std::string_view kEnding = ".aux.xml";

/// Follows from the pixels, or repeats the tags of the image.
bool is_derived(const CPLXMLNode& node) {
  const std::string_view name = node.pszValue;
  if (name == "Histograms") return true;
  if (name == "Metadata") return std::string_view(CPLGetXMLValue(&node, "domain", "")) == "IMAGE_STRUCTURE";
  constexpr std::array<std::string_view, 2> kPrefixes{"STATISTICS_", "EXIF_"};
  const std::string_view key = CPLGetXMLValue(&node, "key", "");
  return name == "MDI" &&
         std::ranges::any_of(kPrefixes, [key](std::string_view prefix) { return key.starts_with(prefix); });
}

bool has_content(const CPLXMLNode& element) {
  for (const CPLXMLNode* part = element.psChild; part != nullptr; part = part->psNext) {
    if (part->eType != CXT_Attribute) return true;
  }
  return false;
}

void remove_derived(CPLXMLNode& element) {
  CPLXMLNode* next = nullptr;
  for (CPLXMLNode* part = element.psChild; part != nullptr; part = next) {
    next = part->psNext;
    if (part->eType != CXT_Element) continue;
    const bool had_content = has_content(*part);
    if (!is_derived(*part)) remove_derived(*part);
    if (is_derived(*part) || (had_content && !has_content(*part))) {
      CPLRemoveXMLChild(&element, part);
      CPLDestroyXMLNode(part);
    }
  }
}

}  // namespace

bool is_aux_xml(const std::string& path) { return lower_case(path).ends_with(kEnding); }

std::string told_by_aux_xml(const std::string& path) {
  const GdalMessages messages;
  const CPLXMLTreeCloser file(CPLParseXMLFile(path.c_str()));
  CPLXMLNode* root = file ? CPLSearchXMLNode(file.get(), "=PAMDataset") : nullptr;
  if (root == nullptr) return {};
  remove_derived(*root);
  if (!has_content(*root)) return {};
  char* text = CPLSerializeXMLTree(root);
  std::string told(text);
  CPLFree(text);
  return told;
}

}  // namespace roadfix
