#include "tiles/sources/exported_roads.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace roadfix {
namespace {

constexpr std::array<const char*, 2> kDescriptions{"TIFFTAG_IMAGEDESCRIPTION", "DESCRIPTION"};
/// The text of core/detect/feature_map_codec as GDAL names it.
constexpr const char* kFeatureMap = "Roadfix_feature_map";
constexpr const char* kSigma = "ROADFIX_REGISTRATION_SIGMA_M";
constexpr std::array<std::pair<const char*, std::string Provenance::*>, 3> kTexts{
    {{"ROADFIX_DATE", &Provenance::date},
     {"ROADFIX_LICENCE", &Provenance::licence},
     {"ROADFIX_ATTRIBUTION", &Provenance::attribution}}};

bool is_feature_map(GDALDataset& dataset) { return CSLFetchNameValue(dataset.GetMetadata(), kFeatureMap) != nullptr; }

bool says_what_it_is(GDALDataset& dataset) {
  if (is_feature_map(dataset) || is_called_as_maps_are(dataset)) return true;
  char** metadata = dataset.GetMetadata();
  return std::ranges::any_of(kDescriptions, [&](const char* name) {
    const char* text = CSLFetchNameValue(metadata, name);
    return text != nullptr && std::string_view(text).starts_with(kExportedRoads);
  });
}

/// Null of other files than VRTs.
DatasetPtr first_image_of(GDALDataset& dataset) {
  if (!EQUAL(dataset.GetDriverName(), "VRT")) return nullptr;
  const std::string own = dataset.GetDescription();
  const GdalMessages messages;
  const CPLStringList files(dataset.GetFileList(), TRUE);
  for (int i = 0; i < files.size(); ++i) {
    if (std::string_view(files[i]).starts_with(own)) continue;  // with its overviews and .aux.xml
    return DatasetPtr(GDALDataset::Open(files[i], GDAL_OF_RASTER | GDAL_OF_READONLY));
  }
  return nullptr;
}

}  // namespace

bool is_called_as_maps_are(GDALDataset& dataset) {
  const char* identifier = CSLFetchNameValue(dataset.GetMetadata(), "IDENTIFIER");
  return identifier != nullptr && std::string_view(identifier) == "road_probability";
}

bool holds_exported_roads(GDALDataset& dataset) {
  if (says_what_it_is(dataset)) return true;
  const DatasetPtr first = first_image_of(dataset);
  return first && says_what_it_is(*first);
}

bool is_bare_copy_of_roads(GDALDataset& dataset) {
  const bool map = EQUAL(dataset.GetDriverName(), "GPKG");
  return !map && !is_feature_map(dataset) && provenance_in(dataset).registration_sigma_m == 0.0;
}

std::vector<std::pair<std::string, std::string>> provenance_items(const Provenance& provenance) {
  std::vector<std::pair<std::string, std::string>> items;
  for (const auto& [name, text] : kTexts) {
    if (!(provenance.*text).empty()) items.emplace_back(name, provenance.*text);
  }
  if (provenance.registration_sigma_m > 0.0) {
    items.emplace_back(kSigma, fmt::format("{}", provenance.registration_sigma_m));
  }
  return items;
}

Provenance provenance_in(GDALDataset& dataset) {
  Provenance provenance;
  char** metadata = dataset.GetMetadata();  // not item by item: some drivers read them only here
  for (const auto& [name, text] : kTexts) {
    const char* value = CSLFetchNameValue(metadata, name);
    if (value != nullptr && CPLIsUTF8(value, -1) != FALSE) provenance.*text = value;
  }
  const char* sigma = CSLFetchNameValue(metadata, kSigma);
  const double sigma_m = sigma == nullptr ? 0.0 : CPLAtof(sigma);
  if (std::isfinite(sigma_m) && sigma_m > 0.0) provenance.registration_sigma_m = sigma_m;
  return provenance;
}

}  // namespace roadfix
