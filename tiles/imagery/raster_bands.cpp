#include "tiles/imagery/raster_bands.hpp"

#include <algorithm>

#include "tiles/imagery/band_colours.hpp"
#include "tiles/imagery/nodata.hpp"

namespace roadfix {
namespace {

/// GDAL before 3.7 knows them by a remark beside the type only, and reads -1 as 255.
bool holds_signed_bytes(GDALRasterBand& band) {
  const char* type = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  return band.GetRasterDataType() == GDT_Byte && type != nullptr && EQUAL(type, "SIGNEDBYTE");
}

bool is_alpha(GDALRasterBand& band) { return band.GetColorInterpretation() == GCI_AlphaBand; }

/// By what the bands are said to mean, or else by their order.
std::vector<int> colours_among(GDALDataset& dataset) {
  const std::array<int, 3> named = colour_bands(dataset);
  if (std::ranges::all_of(named, [](int i) { return i > 0; })) return {named.begin(), named.end()};
  std::vector<int> opaque;
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    if (!is_alpha(*dataset.GetRasterBand(i))) opaque.push_back(i);
  }
  if (opaque.size() >= 3) return {opaque[2], opaque[1], opaque[0]};
  return {opaque.empty() ? 1 : opaque[0]};
}

std::vector<std::array<std::uint8_t, 4>> palette_of(GDALRasterBand& band) {
  std::vector<std::array<std::uint8_t, 4>> palette;
  const GDALColorTable* table = band.GetColorTable();
  for (int i = 0; table != nullptr && i < table->GetColorEntryCount(); ++i) {
    GDALColorEntry entry{};
    table->GetColorEntryAsRGB(i, &entry);
    palette.push_back({static_cast<std::uint8_t>(entry.c3), static_cast<std::uint8_t>(entry.c2),
                       static_cast<std::uint8_t>(entry.c1), static_cast<std::uint8_t>(entry.c4)});
  }
  return palette;
}

}  // namespace

RasterBands bands_of(GDALDataset& dataset) {
  RasterBands bands;
  bands.colours = colours_among(dataset);
  for (const int number : bands.colours) bands.nodata.push_back(nodata_of(*dataset.GetRasterBand(number)));
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    if (is_alpha(*dataset.GetRasterBand(i))) bands.alpha = i;
  }
  GDALRasterBand& first = *dataset.GetRasterBand(bands.colours.front());
  if (bands.colours.size() == 1) bands.palette = palette_of(first);
  bands.has_mask = bands.alpha == 0 && (first.GetMaskFlags() & GMF_PER_DATASET) != 0;
  bands.signed_bytes = holds_signed_bytes(first);
  return bands;
}

cv::Mat colours_of(const cv::Mat& indices, const RasterBands& bands, cv::Mat& valid) {
  constexpr int kOpaque = 128;
  cv::Mat whole;
  indices.convertTo(whole, CV_32S);
  cv::Mat colours(indices.size(), CV_8UC3);
  for (int row = 0; row < whole.rows; ++row) {
    for (int col = 0; col < whole.cols; ++col) {
      const auto index = static_cast<std::size_t>(std::max(0, whole.at<int>(row, col)));
      const auto entry = index < bands.palette.size() ? bands.palette[index] : std::array<std::uint8_t, 4>{};
      colours.at<cv::Vec3b>(row, col) = {entry[0], entry[1], entry[2]};
      if (entry[3] < kOpaque) valid.at<std::uint8_t>(row, col) = 0;
    }
  }
  return colours;
}

}  // namespace roadfix
