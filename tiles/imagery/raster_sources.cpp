#include "tiles/imagery/raster_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "core/detect/blank_ground.hpp"
#include "core/detect/frame.hpp"
#include "core/units/error.hpp"
#include "tiles/imagery/mosaic.hpp"
#include "tiles/imagery/road_values.hpp"
#include "tiles/sources/certainty.hpp"
#include "tiles/sources/fingerprint.hpp"

namespace roadfix {
namespace {

// Where nothing else is known of imagery: 6 m with 95 %, as the orthophotos of the US (NAIP) were specified for long.
constexpr double kImagerySigmaM = 2.5;
constexpr double kRasterSigmaM = 3.0;

/// Side of what is detected at a time, without the halo.
constexpr int kMaxPixels = 2048;
/// Pixels a side of a cell that rasters of roads are read with; what is finer is averaged on the way.
constexpr double kFinestParts = 4.0;

/// `usual_m` where nothing says that the images lie worse.
void state_position(const Mosaic& mosaic, double usual_m, SourceSummary& summary) {
  const auto& [placing, datum] = mosaic.position_errors();
  summary.registration_sigma_m = std::hypot(std::max(usual_m, placing.sigma_m), datum.sigma_m);
  if (placing.sigma_m > usual_m) summary.notes.push_back(placing.reason);
  if (datum.sigma_m > 0.0) summary.notes.push_back(datum.reason);
}

std::string settings_of(const RasterOptions& options) {
  std::string text = options.crs.empty() ? "" : fmt::format(" crs={}", options.crs);
  if (options.collar) {
    text += fmt::format(" nodata-color={},{},{}", options.collar->red, options.collar->green, options.collar->blue);
  }
  return text;
}

/// What was seen of a road raster's picture within a cell. A cell has a few pixels, a city millions of cells, and
/// OpenCV takes longer to begin a sum than to take it.
struct Seen {
  int pixels = 0;
  int sum = 0;
};

Seen seen_in(const GroundImage& image, const cv::Rect& part) {
  Seen seen;
  for (int row = part.y; row < part.y + part.height; ++row) {
    const auto* value = image.pixels.ptr<std::uint8_t>(row, part.x);
    const auto* observed = image.observed.ptr<std::uint8_t>(row, part.x);
    for (int i = 0; i < part.width; ++i) {
      if (observed[i] == 0) continue;
      ++seen.pixels;
      seen.sum += value[i];
    }
  }
  return seen;
}

class Imagery final : public CellSource {
 public:
  Imagery(const std::vector<std::string>& paths, const RasterOptions& options, UtmZone zone, double cell_m,
          const RoadDetector& detector)
      : mosaic_(paths, options, ValueRule::kPicture, zone),
        detector_(detector),
        cell_m_(cell_m),
        gsd_m_(detection_gsd_m(cell_m, detector.preferred_gsd_m(), mosaic_.gsd_m())) {
    require_fine_enough(paths);
    summary_.kind = SourceKind::kImagery;
    summary_.method = method_by(
        detector.describe(), fmt::format("pixels of {} m, values {}..{}, one colour over {} m unseen{}", gsd_m_,
                                         mosaic_.range().low, mosaic_.range().high, kBlankSideM, settings_of(options)));
    summary_.fingerprint = fingerprint(paths, summary_.method);
    summary_.crs = mosaic_.crs();
    summary_.native_gsd_m = mosaic_.gsd_m();
    summary_.chosen_gsd_m = gsd_m_;
    state_position(mosaic_, kImagerySigmaM, summary_);
    std::ranges::move(mosaic_.band_notes(), std::back_inserter(summary_.notes));
  }

  SourceSummary summary() const override { return summary_; }
  GridBox extent() const override { return mosaic_.extent(); }
  bool touches(const GridBox& box) const override { return mosaic_.touches(box); }

  CellArray read(const GridGeometry& block, std::uint64_t seed) const override {
    assert(block.cell_m == cell_m_);
    const int pixels = static_cast<int>(std::lround(cell_m_ / gsd_m_));
    const int side = std::max(1, kMaxPixels / pixels);
    CellArray result(block.cols, block.rows);
    for (int row = 0; row < block.rows; row += side) {
      for (int col = 0; col < block.cols; col += side) {
        const GridGeometry part{cell_m_,
                                {block.origin.col + col, block.origin.row + row},
                                std::min(side, block.cols - col),
                                std::min(side, block.rows - row)};
        detect(part, pixels, seed++, result, {col, row});
      }
    }
    return result;
  }

 private:
  void require_fine_enough(const std::vector<std::string>& paths) const {
    if (mosaic_.gsd_m() <= kCoarsestGsdM) return;
    throw InvalidInput("imagery-too-coarse",
                       fmt::format("{}: pixels of {:.3g} m are too coarse to show roads, at most {} m is allowed: the "
                                   "map would have no roads. If it is a raster of roads, ingest it with --as roads",
                                   paths.front(), mosaic_.gsd_m(), kCoarsestGsdM));
  }

  void detect(const GridGeometry& part, int pixels, std::uint64_t seed, CellArray& result, cv::Point at) const {
    const auto halo = static_cast<int>(std::ceil(detector_.halo_m() / cell_m_));
    const GroundImage image = mosaic_.view(part.padded(halo).box(), gsd_m_);
    const cv::Rect inner(halo * pixels, halo * pixels, part.cols * pixels, part.rows * pixels);
    if (cv::countNonZero(image.observed(inner)) == 0) return;
    const CellArray seen = detector_.detect(image, cell_m_, seed);
    for (int row = 0; row < part.rows; ++row) {
      const auto from =
          seen.row(row + halo).subspan(static_cast<std::size_t>(halo), static_cast<std::size_t>(part.cols));
      std::ranges::copy(from, result.row(at.y + row).begin() + at.x);
    }
  }

  Mosaic mosaic_;
  const RoadDetector& detector_;
  double cell_m_;
  double gsd_m_;
  SourceSummary summary_;
};

class RoadRaster final : public CellSource {
 public:
  RoadRaster(const std::vector<std::string>& paths, const RasterOptions& options, UtmZone zone, double cell_m)
      : mosaic_(paths, options, ValueRule::kShare, zone),
        cell_m_(cell_m),
        gsd_m_(std::max(detection_gsd_m(cell_m, mosaic_.gsd_m(), mosaic_.gsd_m()), cell_m / kFinestParts)) {
    summary_.kind = SourceKind::kRoadRaster;
    const Certainty certainty = certainty_of_values();
    summary_.method =
        fmt::format("raster of roads; values {}..{} become {}..{}, averaged over cells{}", mosaic_.range().low,
                    mosaic_.range().high, certainty.elsewhere, certainty.on_road, settings_of(options));
    summary_.fingerprint = fingerprint(paths, summary_.method);
    summary_.crs = mosaic_.crs();
    summary_.native_gsd_m = mosaic_.gsd_m();
    summary_.chosen_gsd_m = gsd_m_;
    summary_.notes = notes_on_road_values(paths.front(), mosaic_.share_values(), mosaic_.range());
    summary_.told = mosaic_.told();
    const double told_m = summary_.told.registration_sigma_m;
    state_position(mosaic_, told_m > 0.0 ? told_m : kRasterSigmaM, summary_);
    std::optional<std::string> note = mosaic_.exported()
                                          ? note_on_copied_roads(RasterFile(paths.front(), options))
                                          : note_on_likely_picture(paths.front(), options, mosaic_.range());
    if (note) summary_.notes.push_back(std::move(*note));
  }

  SourceSummary summary() const override { return summary_; }
  GridBox extent() const override { return mosaic_.extent(); }
  bool touches(const GridBox& box) const override { return mosaic_.touches(box); }

  CellArray read(const GridGeometry& block, std::uint64_t) const override {
    assert(block.cell_m == cell_m_);
    const GroundImage image = mosaic_.view(block.box(), gsd_m_);
    const auto pixels = static_cast<int>(std::lround(cell_m_ / gsd_m_));
    const Certainty certainty = certainty_of_values();
    CellArray result(block.cols, block.rows);
    for (int row = 0; row < block.rows; ++row) {
      for (int col = 0; col < block.cols; ++col) {
        const Seen seen = seen_in(image, cv::Rect(col * pixels, row * pixels, pixels, pixels));
        if (2 * seen.pixels < pixels * pixels) continue;
        const double share = seen.sum * (1.0 / seen.pixels) / 255.0;
        result.at(col, row) = cell_from_probability(certainty.probability(share));
      }
    }
    return result;
  }

 private:
  Certainty certainty_of_values() const {
    return mosaic_.holds_integers() && !mosaic_.exported() ? Certainty{} : Certainty{1.0, 0.0};
  }

  Mosaic mosaic_;
  double cell_m_;
  double gsd_m_;
  SourceSummary summary_;
};

}  // namespace

double detection_gsd_m(double cell_m, double preferred_gsd_m, double native_gsd_m) {
  const double wanted = std::max(preferred_gsd_m, native_gsd_m);
  const long halvings = std::clamp(std::lround(std::log2(cell_m / wanted)), 0L, 10L);
  return std::ldexp(cell_m, -static_cast<int>(halvings));
}

std::unique_ptr<CellSource> open_imagery(const std::vector<std::string>& paths, const RasterOptions& options,
                                         UtmZone zone, double cell_m, const RoadDetector& detector) {
  return std::make_unique<Imagery>(paths, options, zone, cell_m, detector);
}

std::unique_ptr<CellSource> open_road_raster(const std::vector<std::string>& paths, const RasterOptions& options,
                                             UtmZone zone, double cell_m) {
  return std::make_unique<RoadRaster>(paths, options, zone, cell_m);
}

}  // namespace roadfix
