#include "tiles/sources/band_notes.hpp"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "tiles/sources/road_values.hpp"

namespace roadfix {
namespace {

std::optional<std::string> note_on_colours(const RasterFile& file) {
  GDALDataset& dataset = file.dataset();
  int bands = 0;
  int named = 0;
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    const GDALColorInterp meaning = dataset.GetRasterBand(i)->GetColorInterpretation();
    named += meaning == GCI_RedBand || meaning == GCI_GreenBand || meaning == GCI_BlueBand ? 1 : 0;
    bands += meaning == GCI_AlphaBand ? 0 : 1;
  }
  if (named >= 3 || bands < 3 || (named == 0 && bands == 3)) return std::nullopt;
  const std::string unsaid = named == 0
                                 ? fmt::format("nothing says which of its {} bands are red, green and blue", bands)
                                 : fmt::format("not all of red, green and blue are named among its {} bands", bands);
  return fmt::format(
      "{}: {}, so the first three are taken for them in this order. If others are, name them (gdal_edit.py "
      "-colorinterp_3 red -colorinterp_2 green -colorinterp_1 blue) and run this again (ingest: with --replace)",
      file.path(), unsaid);
}

std::optional<std::string> note_on_alpha(RasterFile& file) {
  constexpr double kTransparent = 0.02;
  constexpr double kWorthNoting = 0.1;
  const int band = file.alpha_band();
  if (band == 0) return std::nullopt;
  int seen = 0;
  int graded = 0;
  for (const cv::Rect& window : file.sample_windows()) {
    const cv::Mat opacity = file.read_opacity(window);
    seen += window.area();
    graded += cv::countNonZero((opacity > kTransparent) & (opacity < 1.0 - kTransparent));
  }
  if (graded <= kWorthNoting * seen) return std::nullopt;
  return fmt::format(
      "{0}: {1:.0f} % of it is half transparent by its alpha band, band {2}, and what is less than half opaque counts "
      "as not seen. If band {2} holds something else, such as near infrared, say so (gdal_edit.py -colorinterp_{2} "
      "undefined) and run this again (ingest: with --replace)",
      file.path(), 100.0 * graded / seen, band);
}

std::optional<std::string> note_on_likely_heights(const RasterFile& file) {
  if (!looks_like_heights(file)) return std::nullopt;
  return fmt::format(
      "{}: it has one band of real numbers, as heights have, and they are taken for brightness. If they are heights, "
      "give the orthophoto itself (roadfix remove takes out of a map what was ingested)",
      file.path());
}

}  // namespace

bool looks_like_heights(const RasterFile& file) { return file.channels() == 1 && !file.holds_integers(); }

std::vector<std::string> notes_on_imagery(const std::string& path, const RasterOptions& options) {
  RasterFile file(path, options);
  std::optional<std::string> meaning = note_on_likely_roads(path, options);
  if (!meaning) meaning = note_on_likely_heights(file);
  std::vector<std::string> notes;
  for (auto& note : {std::move(meaning), note_on_colours(file), note_on_alpha(file)}) {
    if (note) notes.push_back(*note);
  }
  return notes;
}

}  // namespace roadfix
