#include "core/detect/feature_map_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/detect/frame_image.hpp"
#include "core/detect/ground_scale.hpp"
#include "core/grid/cell_size.hpp"
#include "core/png/plain_png.hpp"
#include "core/png/png_text.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr std::string_view kKeyword = "Roadfix feature map";

/// A frame that was sent as a feature map would be searched for as if its brightness were road.
void refuse_coloured(const FramePixels& picture) {
  constexpr int kStillGrey = 12;
  constexpr double kStray = 0.01;
  if (picture.pixels.channels() == 1) return;
  std::vector<cv::Mat> channels;
  cv::split(picture.pixels, channels);
  const cv::Mat spread =
      cv::max(cv::max(channels[0], channels[1]), channels[2]) - cv::min(cv::min(channels[0], channels[1]), channels[2]);
  const int coloured = cv::countNonZero((spread > kStillGrey) & picture.observed);
  if (coloured <= kStray * cv::countNonZero(picture.observed)) return;
  throw InvalidInput("feature-map-coloured",
                     fmt::format("a feature map is grey, but {} pixels of this picture are coloured: if it is a frame, "
                                 "say so and give its metres per pixel or its camera",
                                 coloured));
}

/// 16 bits scaled linearly. Stretched as those of a frame are, doubtful roads would be certain ones, and the noise of
/// empty ground a town.
cv::Mat scaled_to_eight_bits(const cv::Mat& image) {
  if (image.depth() != CV_16U) return image;
  cv::Mat scaled;
  image.convertTo(scaled, CV_8U, 255.0 / 65535.0);
  return scaled;
}

CellArray cells_of(const cv::Mat& image) {
  const FramePixels frame = frame_image(scaled_to_eight_bits(image));
  refuse_coloured(frame);
  const cv::Mat grey = brightness_of(frame.pixels);
  CellArray cells(grey.cols, grey.rows);
  for (int row = 0; row < grey.rows; ++row) {
    for (int col = 0; col < grey.cols; ++col) {
      if (frame.observed.at<uchar>(row, col) != 0) cells.at(col, row) = std::min(grey.at<uchar>(row, col), kRoad);
    }
  }
  return cells;
}

constexpr std::size_t kLongestReader = 500;

std::string text_of(const FeatureMap& map, const std::string& reader) {
  nlohmann::json text{{"cols", map.cells.cols()},
                      {"rows", map.cells.rows()},
                      {"cell_m", map.cell_m},
                      {"nadir_cell", {map.nadir.col, map.nadir.row}},
                      {"nadir_sigma_m", map.nadir_sigma_m},
                      {"nadir_heading_sigma_rad", map.nadir_heading_sigma.radians()}};
  if (!reader.empty()) text["reader"] = reader.substr(0, kLongestReader);
  constexpr bool kInAscii = true;
  return text.dump(-1, ' ', kInAscii, nlohmann::json::error_handler_t::replace);
}

[[noreturn]] void refuse_altered(const CellArray& cells) {
  throw InvalidInput("feature-map-altered",
                     fmt::format("this picture of {} x {} cells was cut, scaled or written anew since it was made, so "
                                 "that what it says of its cell size and of the point below the UAV no longer holds: "
                                 "detect the roads again, or remove its PNG text '{}' and tell both",
                                 cells.cols(), cells.rows(), kKeyword));
}

bool is_sound(const FeatureMapScale& scale) {
  constexpr double kMaxCellM = 1000.0;
  constexpr double kMaxNadir = 1e6;
  constexpr double kMaxSigmaM = 1000.0;
  constexpr Angle kMaxHeadingSigma = Angle::degrees(180.0);
  return scale.cell_m > 0.0 && scale.cell_m <= kMaxCellM && std::abs(scale.nadir.col) <= kMaxNadir &&
         std::abs(scale.nadir.row) <= kMaxNadir && scale.nadir_sigma_m >= 0.0 && scale.nadir_sigma_m <= kMaxSigmaM &&
         scale.nadir_heading_sigma >= Angle() && scale.nadir_heading_sigma <= kMaxHeadingSigma;
}

FeatureMapScale scale_of(const std::string& text, const CellArray& cells) {
  constexpr std::size_t kLongest = 500 + 6 * kLongestReader;  // of which JSON escapes each character
  if (text.size() > kLongest) refuse_altered(cells);
  try {
    const auto json = nlohmann::json::parse(text);
    const auto number = [](const nlohmann::json& value) { return value.get<double>(); };
    const auto& nadir = json.at("nadir_cell");
    FeatureMapScale scale{number(json.at("cell_m")),
                          {number(nadir.at(0)), number(nadir.at(1))},
                          number(json.at("nadir_sigma_m")),
                          Angle::radians(number(json.at("nadir_heading_sigma_rad"))),
                          json.value("reader", "")};
    if (json.at("cols") != cells.cols() || json.at("rows") != cells.rows() || !is_sound(scale)) refuse_altered(cells);
    return scale;
  } catch (const nlohmann::json::exception&) {
    refuse_altered(cells);
  }
}

void require_agreement(const FeatureMap& map, const ToldScale& told) {
  if (told.cell_m && !is_same_cell_size(*told.cell_m, map.cell_m)) {
    throw InvalidInput("cell-size-contradictory",
                       fmt::format("the picture says that its cells have {} m, not {} m: leave the cell size out",
                                   map.cell_m, *told.cell_m));
  }
  constexpr double kSameCells = 0.01;
  const GridGeometry::CellPosition nadir{told.nadir_col.value_or(map.nadir.col),
                                         told.nadir_row.value_or(map.nadir.row)};
  if (std::abs(nadir.col - map.nadir.col) > kSameCells || std::abs(nadir.row - map.nadir.row) > kSameCells) {
    throw InvalidInput(
        "nadir-contradictory",
        fmt::format("the picture says that the UAV was above its column {:.2f} and row {:.2f}, not {:.2f} "
                    "and {:.2f}: leave the nadir out",
                    map.nadir.col, map.nadir.row, nadir.col, nadir.row));
  }
}

}  // namespace

FeatureMapPicture decode_feature_map(Bytes bytes, std::int64_t max_pixels) {
  FeatureMapPicture picture{cells_of(decode_image(bytes, max_pixels)), {}};
  if (const auto text = text_in(bytes, kKeyword)) picture.scale = scale_of(*text, picture.cells);
  return picture;
}

bool is_feature_map(Bytes bytes) { return text_in(bytes, kKeyword).has_value(); }

FeatureMap feature_map_of(FeatureMapPicture picture, const ToldScale& told) {
  assert(told.cell_m || picture.scale);
  FeatureMap map = FeatureMap::centred(std::move(picture.cells), told.cell_m.value_or(1.0));
  if (!picture.scale) {
    map.nadir = {told.nadir_col.value_or(map.nadir.col), told.nadir_row.value_or(map.nadir.row)};
    return map;
  }
  map.cell_m = picture.scale->cell_m;
  map.nadir = picture.scale->nadir;
  map.nadir_sigma_m = picture.scale->nadir_sigma_m;
  map.nadir_heading_sigma = picture.scale->nadir_heading_sigma;
  require_agreement(map, told);
  return map;
}

cv::Mat decode_frame(Bytes bytes, std::int64_t max_pixels, const std::stop_token& stop) {
  if (!is_feature_map(bytes)) return decode_image(bytes, max_pixels, stop);
  throw InvalidInput("frame-is-feature-map",
                     "this picture shows roads that were detected before, and no ground: give it as the feature map "
                     "that it says it is, without what describes a frame");
}

std::vector<std::uint8_t> encode_feature_map(const FeatureMap& map, const std::string& reader) {
  return with_text(encode_feature_map(map.cells), kKeyword, text_of(map, reader));
}

std::vector<std::uint8_t> encode_feature_map(const CellArray& cells) {
  constexpr int kLongestSide = 1'000'000;  // of libpng
  if (std::max(cells.cols(), cells.rows()) > kLongestSide) {
    throw LimitExceeded(
        "too-many-cells",
        fmt::format("a PNG has at most {} columns and rows, not {} x {}: ask for larger cells, a smaller "
                    "window or another format",
                    kLongestSide, cells.cols(), cells.rows()));
  }
  std::vector<std::uint8_t> grey_and_alpha;
  grey_and_alpha.reserve(2 * cells.cells().size());
  for (const Cell cell : cells.cells()) {
    grey_and_alpha.push_back(is_observed(cell) ? cell : 0);
    grey_and_alpha.push_back(is_observed(cell) ? 255 : 0);
  }
  const std::vector<std::byte> png = encode_plain_png(grey_and_alpha, {cells.cols(), cells.rows(), 2, 8});
  const auto* first = reinterpret_cast<const std::uint8_t*>(png.data());
  return {first, first + png.size()};
}

}  // namespace roadfix
