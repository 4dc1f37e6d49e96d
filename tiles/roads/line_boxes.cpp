#include "tiles/roads/line_boxes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

GridBox box_of(const RoadNetwork& network, const RoadLine& line) {
  return box_around(std::span(network.points).subspan(line.first_point, line.points));
}

std::vector<GridBox> boxes_of(const RoadNetwork& network, std::span<const RoadLine> lines) {
  std::vector<GridBox> boxes;
  boxes.reserve(lines.size());
  for (const RoadLine& line : lines) boxes.push_back(box_of(network, line));
  return boxes;
}

GridBox middle_of(std::span<const GridBox> boxes, std::size_t one_in) {
  const std::size_t beside = boxes.size() / one_in;
  std::vector<double> rims(boxes.size());
  const auto rim = [&](const auto& of, std::size_t rank) {
    std::ranges::transform(boxes, rims.begin(), of);
    const auto at = rims.begin() + static_cast<std::ptrdiff_t>(rank);
    std::ranges::nth_element(rims, at);
    return *at;
  };
  const std::size_t last = boxes.size() - 1 - beside;
  return {{rim([](const GridBox& box) { return box.min.east_m; }, beside),
           rim([](const GridBox& box) { return box.min.north_m; }, beside)},
          {rim([](const GridBox& box) { return box.max.east_m; }, last),
           rim([](const GridBox& box) { return box.max.north_m; }, last)}};
}

// Not by UtmZone: the lines may lie far from the zone.
std::optional<OGREnvelope> box_on_earth(const GridBox& box, UtmZone zone) {
  constexpr int kPointsOfASide = 21;
  const GdalMessages messages;
  const TransformationPtr to_earth = transformation(utm_reference(zone), wgs84_reference(), "the roads");
  OGREnvelope degrees;
  const int known =
      to_earth->TransformBounds(box.min.east_m, box.min.north_m, box.max.east_m, box.max.north_m, &degrees.MinX,
                                &degrees.MinY, &degrees.MaxX, &degrees.MaxY, kPointsOfASide);
  return known == FALSE ? std::nullopt : std::optional(degrees);
}

std::string extent_text(const OGREnvelope& degrees) {
  const auto down = [](double at) { return std::floor(at * 1e4) / 1e4; };
  const auto up = [](double at) { return std::ceil(at * 1e4) / 1e4; };
  return fmt::format("{:.4f},{:.4f},{:.4f},{:.4f}", down(degrees.MinX), down(degrees.MinY), up(degrees.MaxX),
                     up(degrees.MaxY));
}

}  // namespace roadfix
