#include "tiles/sources/road_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/units/error.hpp"

namespace roadfix {

std::vector<std::string> notes_on_road_values(const std::string& path, const ValueRange& sampled,
                                              const ValueRange& range, bool integers) {
  if (sampled.low > sampled.high) return {};
  constexpr double kResampling = 0.1;  // by which cubic resampling overshoots
  if (sampled.low < -kResampling * range.high || (!integers && sampled.high > (1.0 + kResampling) * range.high)) {
    throw InvalidInput(
        "road-values-out-of-range",
        fmt::format("{}: its values go from {:g} to {:g}, but a raster of roads holds {} from 0 to {:g}. Mark values "
                    "that mean nothing as nodata (gdal_edit.py -a_nodata), rescale others (gdal_translate -scale)",
                    path, sampled.low, sampled.high, integers ? "integers" : "probabilities", range.high));
  }
  constexpr double kHalf = 0.5;
  std::vector<std::string> notes;
  if (sampled.low > kHalf * range.high) {
    notes.push_back(fmt::format(
        "{}: every pixel with data is road, so that nothing is known to be no road, and places look alike. If nodata "
        "stands for no road here, take the mark away (gdal_edit.py -unsetnodata) and use --replace",
        path));
  }
  if (integers && sampled.high > 0.0 && sampled.high < kHalf * range.high) {
    notes.push_back(fmt::format(
        "{}: its largest value is {:g} of {:g}, so that no road is surer than {:.0f} %. If it stands for certain, "
        "rescale it (gdal_translate -scale 0 {:g} 0 {:g})",
        path, sampled.high, range.high, 100.0 * sampled.high / range.high, sampled.high, range.high));
  }
  return notes;
}

std::optional<std::string> note_on_likely_picture(const std::string& path, const RasterOptions& options) {
  RasterFile file(path, options);
  if (file.channels() != 3) return std::nullopt;
  const std::vector<float> values = file.sample_values();
  if (values.empty()) return std::nullopt;
  const float most = *std::ranges::max_element(values);
  std::size_t coloured = 0;
  for (std::size_t i = 0; i < values.size(); i += 3) {
    const auto [least, largest] = std::ranges::minmax(std::span(values).subspan(i, 3));
    coloured += largest - least > 0.05F * most ? 1 : 0;
  }
  if (10 * coloured < values.size() / 3) return std::nullopt;
  return fmt::format(
      "{}: it is in colour, and its brightness is taken for the probability of road. If it shows the ground rather "
      "than roads, ingest it without --as roads (and --replace this source)",
      path);
}

std::optional<std::string> note_on_likely_roads(const std::string& path, const RasterOptions& options) {
  RasterFile file(path, options);
  if (file.channels() != 1) return std::nullopt;
  const std::vector<float> values = file.sample_values();
  if (values.empty()) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(values);
  const bool mask =
      least < most && std::ranges::all_of(values, [&, a = least, b = most](float v) { return v == a || v == b; });
  const bool probabilities = !file.holds_integers() && least < most && least >= 0.0F && most <= 1.0F;
  if (!mask && !probabilities) return std::nullopt;
  return fmt::format(
      "{}: its values are {:g} {} {:g}, as those of {}. If it shows roads rather than the ground, give --as roads",
      path, least, mask ? "and" : "to", most, mask ? "a mask of roads are" : "probabilities are");
}

}  // namespace roadfix
