#include "tiles/imagery/band_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "tiles/imagery/band_colours.hpp"
#include "tiles/imagery/road_values.hpp"

namespace roadfix {
namespace {

std::optional<std::string> note_on_colours(const RasterFile& file) {
  GDALDataset& dataset = file.dataset();
  const std::array<int, 3> colours = colour_bands(dataset);
  const std::ptrdiff_t named = std::ranges::count_if(colours, [](int i) { return i > 0; });
  int bands = 0;
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    bands += dataset.GetRasterBand(i)->GetColorInterpretation() == GCI_AlphaBand ? 0 : 1;
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
  constexpr double kWorthNoting = 0.1;
  const int band = file.alpha_band();
  if (band == 0) return std::nullopt;
  const AlphaScale& opacity = file.opacity();
  if (opacity.varied) {
    return fmt::format(
        "{0}: the values of its alpha band, band {1}, vary as those of near infrared do, so only what is next to 0 "
        "there counts as not seen. If it does hold something else than opacity, say so (gdal_edit.py -colorinterp_{1} "
        "undefined) and run this again (ingest: with --replace); if not, make it 0 and 255",
        file.path(), band);
  }
  if (opacity.graded <= kWorthNoting) return std::nullopt;
  return fmt::format(
      "{0}: {1:.0f} % of it is half transparent by its alpha band, band {2}, and what is less than half opaque counts "
      "as not seen. If band {2} holds something else, such as near infrared, say so (gdal_edit.py -colorinterp_{2} "
      "undefined) and run this again (ingest: with --replace)",
      file.path(), 100.0 * opacity.graded, band);
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

void BandNotes::add(RasterFile& file) {
  std::optional<std::string> meaning = note_on_likely_roads(file);
  if (!meaning) meaning = note_on_likely_heights(file);
  const std::array notes{std::move(meaning), note_on_colours(file), note_on_alpha(file)};
  for (std::size_t i = 0; i < notes.size(); ++i) {
    if (!notes[i]) continue;
    Kind& kind = kinds_[i];
    if (kind.first.empty()) {
      kind.first = *notes[i];
    } else if (kind.others++ == 0) {
      kind.next = file.path();
    }
  }
}

std::vector<std::string> BandNotes::texts() const {
  std::vector<std::string> texts;
  for (const Kind& kind : kinds_) {
    if (kind.first.empty()) continue;
    texts.push_back(kind.first);
    if (kind.others > 0) {
      texts.back() +=
          fmt::format(". The like holds for {} of its other images, the first of them {}", kind.others, kind.next);
    }
  }
  return texts;
}

}  // namespace roadfix
