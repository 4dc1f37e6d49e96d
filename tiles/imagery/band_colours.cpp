#include "tiles/imagery/band_colours.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "core/units/text.hpp"

namespace roadfix {
namespace {

using Bands = std::array<int, 3>;

/// Of the bands for which `is(band, colour)`, where colours are counted from blue.
template <typename Is>
Bands bands_that(GDALDataset& dataset, const Is& is) {
  Bands bands{0, 0, 0};
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    for (std::size_t colour = 0; colour < bands.size(); ++colour) {
      if (is(*dataset.GetRasterBand(i), colour)) bands[colour] = i;
    }
  }
  return bands;
}

bool are_complete(const Bands& bands) {
  return std::ranges::all_of(bands, [](int i) { return i > 0; });
}

}  // namespace

std::array<int, 3> colour_bands(GDALDataset& dataset) {
  constexpr std::array kMeanings{GCI_BlueBand, GCI_GreenBand, GCI_RedBand};
  constexpr std::array kNames{"blue", "green", "red"};
  const Bands by_meaning = bands_that(dataset, [&](GDALRasterBand& band, std::size_t colour) {
    return band.GetColorInterpretation() == kMeanings[colour];
  });
  if (are_complete(by_meaning)) return by_meaning;
  const Bands by_name = bands_that(dataset, [&](GDALRasterBand& band, std::size_t colour) {
    return lower_case(band.GetDescription()) == kNames[colour];
  });
  return are_complete(by_name) ? by_name : by_meaning;
}

}  // namespace roadfix
