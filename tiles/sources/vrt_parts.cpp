#include "tiles/sources/vrt_parts.hpp"

#include <cpl_minixml.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

namespace roadfix {
namespace {

/// 0 where there is none.
double number_at(const CPLXMLNode* node, const char* path) { return std::atof(CPLGetXMLValue(node, path, "0")); }

const CPLXMLNode* band_of(const CPLXMLNode* root, int band) {
  const CPLXMLNode* child = CPLGetXMLNode(root, "VRTRasterBand");
  for (; child != nullptr; child = child->psNext) {
    const bool is_band = child->eType == CXT_Element && std::string_view(child->pszValue) == "VRTRasterBand";
    if (is_band && std::atoi(CPLGetXMLValue(child, "band", "0")) == band) return child;
  }
  return nullptr;
}

/// Whether its pixels are those of its images, one over the other: not warped, sharpened or computed.
bool is_mosaic(const CPLXMLNode* band) {
  const std::string_view subclass = CPLGetXMLValue(band, "subClass", "");
  return subclass.empty() || subclass == "VRTSourcedRasterBand";
}

}  // namespace

std::optional<std::vector<cv::Rect>> filled_parts(GDALDataset& dataset, int band) {
  char** xml = dataset.GetMetadata("xml:VRT");
  if (xml == nullptr || *xml == nullptr) return std::nullopt;
  const CPLXMLTreeCloser tree(CPLParseXMLString(*xml));
  const CPLXMLNode* root = tree ? CPLGetXMLNode(tree.get(), "=VRTDataset") : nullptr;
  const CPLXMLNode* node = root != nullptr ? band_of(root, band) : nullptr;
  if (node == nullptr || !is_mosaic(node)) return std::nullopt;
  const double across = dataset.GetRasterXSize() / number_at(root, "rasterXSize");
  const double down = dataset.GetRasterYSize() / number_at(root, "rasterYSize");
  // Edges are rounded, so that images that meet within a pixel leave no gap.
  const auto edge = [](double at, double scale) { return static_cast<int>(std::lround(at * scale)); };
  std::vector<cv::Rect> parts;
  for (const CPLXMLNode* child = node->psChild; child != nullptr; child = child->psNext) {
    if (child->eType != CXT_Element || !std::string_view(child->pszValue).ends_with("Source")) continue;
    const CPLXMLNode* placed = CPLGetXMLNode(child, "DstRect");
    if (placed == nullptr) return std::nullopt;  // fills all
    const double x = number_at(placed, "xOff");
    const double y = number_at(placed, "yOff");
    const cv::Point first(edge(x, across), edge(y, down));
    const cv::Point end(edge(x + number_at(placed, "xSize"), across), edge(y + number_at(placed, "ySize"), down));
    parts.emplace_back(first, end);
  }
  if (parts.empty()) return std::nullopt;
  return parts;
}

void clear_beside(const std::vector<cv::Rect>& parts, cv::Rect window, cv::Mat& valid) {
  cv::Mat filled(valid.size(), CV_8UC1, cv::Scalar(0));
  for (const cv::Rect& part : parts) {
    const cv::Rect common = part & window;
    if (!common.empty()) filled(common - window.tl()).setTo(255);
  }
  cv::bitwise_and(valid, filled, valid);
}

}  // namespace roadfix
