#include "tiles/imagery/vrt_parts.hpp"

#include <cpl_conv.h>
#include <cpl_minixml.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>

#include "core/units/text.hpp"

namespace roadfix {
namespace {

/// 0 where there is none.
double number_at(const CPLXMLNode* node, const char* path) { return CPLAtof(CPLGetXMLValue(node, path, "0")); }

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

bool is_vrt(const std::string& name) { return lower_case(name).ends_with(".vrt"); }

cv::Rect2d rectangle_of(const CPLXMLNode* element) {
  return {number_at(element, "xOff"), number_at(element, "yOff"), number_at(element, "xSize"),
          number_at(element, "ySize")};
}

/// Where a part of `from` lies when all of `from` is scaled to fill `to`.
cv::Rect2d moved(const cv::Rect2d& part, const cv::Rect2d& from, const cv::Rect2d& to) {
  const double across = to.width / from.width;
  const double down = to.height / from.height;
  return {to.x + (part.x - from.x) * across, to.y + (part.y - from.y) * down, part.width * across, part.height * down};
}

/// VRTs within each other, as those of a country's regions are; one may name itself in other words.
constexpr std::size_t kDeepest = 8;

using Parts = std::vector<cv::Rect2d>;

std::optional<Parts> parts_of(GDALDataset& vrt, int band, std::vector<std::string>& around);

/// What a source fills of the VRT in which it is placed: less than all of its place where it is a VRT with gaps.
/// `around` are the files of the VRTs in which it lies.
Parts parts_of_source(const CPLXMLNode* source, const cv::Rect2d& place, std::vector<std::string>& around) {
  const std::string name = CPLGetXMLValue(source, "SourceFilename", "");
  const bool beside = std::atoi(CPLGetXMLValue(source, "SourceFilename.relativeToVRT", "0")) != 0;
  const std::string path = beside ? CPLProjectRelativeFilename(CPLGetPath(around.back().c_str()), name.c_str()) : name;
  const bool endless = around.size() == kDeepest || std::ranges::find(around, path) != around.end();
  if (!is_vrt(path) || endless) return {place};
  const GdalMessages messages;
  const DatasetPtr inner(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!inner) return {place};  // reading it says why
  around.push_back(path);
  const auto parts = parts_of(*inner, std::atoi(CPLGetXMLValue(source, "SourceBand", "1")), around);
  around.pop_back();
  if (!parts) return {place};
  const CPLXMLNode* cut = CPLGetXMLNode(source, "SrcRect");
  const cv::Rect2d seen =
      cut != nullptr ? rectangle_of(cut) : cv::Rect2d(0.0, 0.0, inner->GetRasterXSize(), inner->GetRasterYSize());
  Parts result;
  for (const cv::Rect2d& part : *parts) {
    const cv::Rect2d common = part & seen;
    if (!common.empty()) result.push_back(moved(common, seen, place));
  }
  return result;
}

/// In pixels of the dataset, which may be an overview of its VRT; nullopt where all of it counts as filled.
std::optional<Parts> parts_of(GDALDataset& vrt, int band, std::vector<std::string>& around) {
  char** xml = vrt.GetMetadata("xml:VRT");
  if (xml == nullptr || *xml == nullptr) return std::nullopt;
  const CPLXMLTreeCloser tree(CPLParseXMLString(*xml));
  const CPLXMLNode* root = tree ? CPLGetXMLNode(tree.get(), "=VRTDataset") : nullptr;
  const CPLXMLNode* node = root != nullptr ? band_of(root, band) : nullptr;
  if (node == nullptr || !is_mosaic(node)) return std::nullopt;
  const cv::Rect2d whole(0.0, 0.0, number_at(root, "rasterXSize"), number_at(root, "rasterYSize"));
  const cv::Rect2d pixels(0.0, 0.0, vrt.GetRasterXSize(), vrt.GetRasterYSize());
  Parts parts;
  bool sources = false;
  for (const CPLXMLNode* child = node->psChild; child != nullptr; child = child->psNext) {
    if (child->eType != CXT_Element || !std::string_view(child->pszValue).ends_with("Source")) continue;
    const CPLXMLNode* place = CPLGetXMLNode(child, "DstRect");
    if (place == nullptr) return std::nullopt;  // fills all
    sources = true;
    std::ranges::move(parts_of_source(child, moved(rectangle_of(place), whole, pixels), around),
                      std::back_inserter(parts));
  }
  if (!sources) return std::nullopt;
  return parts;
}

}  // namespace

std::optional<std::vector<cv::Rect>> filled_parts(GDALDataset& dataset, int band) {
  std::vector<std::string> around{dataset.GetDescription()};
  const auto parts = parts_of(dataset, band, around);
  if (!parts) return std::nullopt;
  // Edges are rounded, so that images that meet within a pixel leave no gap.
  const auto corner = [](const cv::Point2d& at) {
    return cv::Point(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)));
  };
  std::vector<cv::Rect> rounded;
  for (const cv::Rect2d& part : *parts) rounded.emplace_back(corner(part.tl()), corner(part.br()));
  return rounded;
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
