#include "tiles/roads/road_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/units/shell_word.hpp"

namespace roadfix {
namespace {

constexpr double kWorthNoting = 0.02;  // of the lines
constexpr const char* kAreasAsRaster =
    "burn them into a raster (gdal_rasterize -burn 255 -init 0 -ot Byte) and ingest that with --as roads";

/// The most frequent of them: "Autobahn (12), Feldweg (3)".
std::string most_frequent(const std::map<std::string, std::int64_t>& counts) {
  constexpr std::size_t kNamed = 8;
  std::vector<std::pair<std::int64_t, std::string>> order;
  for (const auto& [name, count] : counts) order.emplace_back(-count, name);
  std::ranges::sort(order);
  std::string text;
  for (std::size_t i = 0; i < std::min(order.size(), kNamed); ++i) {
    text += fmt::format("{}{} ({})", i == 0 ? "" : ", ", order[i].second, -order[i].first);
  }
  return order.size() > kNamed ? text + " and others" : text;
}

/// A few features of odd classes are in every extract of OpenStreetMap; more of them are missing roads.
void note_unknown_classes(const LineCounts& counts, RoadNetwork& network) {
  std::int64_t unknown = 0;
  for (const auto& [name, count] : counts.unknown_classes) unknown += count;
  if (static_cast<double>(unknown) <= kWorthNoting * static_cast<double>(counts.lines)) return;
  network.notes.push_back(fmt::format(
      "{} of {} lines are not drawn, since the road rules do not know their classes: {}. --rules FILE gives "
      "widths to them; it replaces the built-in rules, so name all classes that are roads in it",
      unknown, counts.lines, most_frequent(counts.unknown_classes)));
}

std::string class_attribute_of(const RoadNetwork& network, const RoadRules& rules) {
  return network.class_attribute.empty() ? rules.class_attribute() : network.class_attribute;
}

/// Whoever draws roads by hand forgets an attribute now and then.
void note_roads_without_class(const LineCounts& counts, const RoadRules& rules, RoadNetwork& network) {
  if (counts.roads_without_class == 0) return;
  network.notes.push_back(
      fmt::format("{} of {} lines are not drawn, since their attribute '{}' is empty. If they are roads, fill it in",
                  counts.roads_without_class, counts.lines, class_attribute_of(network, rules)));
}

void note_impossible_lines(const LineCounts& counts, RoadNetwork& network) {
  if (counts.impossible == 0) return;
  network.notes.push_back(
      fmt::format("{} of {} lines are left out, since no place on Earth has their coordinates; the first is feature {}",
                  counts.impossible, counts.lines + counts.impossible, counts.first_impossible));
}

void note_lines_without_geometry(const LineCounts& counts, RoadNetwork& network) {
  if (counts.without_geometry == 0) return;
  network.notes.push_back(fmt::format(
      "{} of {} lines have no geometry and are left out, so that where they should lie counts as no road. If "
      "they are roads, export them again",
      counts.without_geometry, counts.lines + counts.impossible + counts.without_geometry));
}

/// A few squares are in every extract of OpenStreetMap; more areas are missing roads.
void note_areas(RoadNetwork& network) {
  const std::size_t lines = network.lines.size();
  if (static_cast<double>(network.areas) <= kWorthNoting * static_cast<double>(lines)) return;
  network.notes.push_back(
      fmt::format("areas are not drawn, so that the ground of {} counts as no road (lines that are drawn: {}). If they "
                  "are roads, {}",
                  network.areas, lines, kAreasAsRaster));
}

/// Roads three times as wide as they are make a map that fits nowhere.
void note_widths(const RoadRules& rules, RoadNetwork& network) {
  const auto is_asked = [&](const auto& stated) { return rules.is_width_attribute(stated.first); };
  if (!rules.width_attribute().empty() && std::ranges::none_of(network.stated_widths, is_asked)) {
    network.notes.push_back(
        fmt::format("no road states a width in the attribute '{}', which --width-attribute names: widths come from "
                    "elsewhere. It is read where it says 7.5, '7.5 m' or '24 ft', from 0.5 to 100 m",
                    rules.width_attribute()));
  }
  for (auto& [attribute, widths] : network.stated_widths) {
    const auto middle = widths.begin() + std::ssize(widths) / 2;
    std::ranges::nth_element(widths, middle);
    const bool feet = rules.unit_of(attribute) == WidthUnit::kFoot;
    network.notes.push_back(fmt::format(
        "widths of {} roads from the attribute '{}', plain numbers taken for {}: median {:.3g} m{}", widths.size(),
        attribute, feet ? "feet" : "metres", *middle,
        feet ? "" : fmt::format(". If they are feet, give --width-attribute {}", shell_word(attribute + ":ft"))));
  }
}

}  // namespace

void add_notes(const LineCounts& counts, const RoadRules& rules, RoadNetwork& network) {
  note_impossible_lines(counts, network);
  note_lines_without_geometry(counts, network);
  note_unknown_classes(counts, network);
  note_roads_without_class(counts, rules, network);
  note_areas(network);
  note_widths(rules, network);
}

std::string why_none_is_drawn(const LineCounts& counts, const RoadNetwork& network, const RoadRules& rules) {
  if (counts.lines == 0) {
    return fmt::format(
        "none of them is a line; points and areas are not drawn, centrelines are. To use areas of road, {}",
        kAreasAsRaster);
  }
  if (counts.without_class == counts.lines) {
    return fmt::format("their attribute '{}' is empty; fill it in, or name another with --class-attribute",
                       class_attribute_of(network, rules));
  }
  if (!counts.unknown_classes.empty()) {
    return fmt::format(
        "the road rules do not know their classes, {}; give them widths with --rules FILE, which replaces the built-in "
        "rules, or name another attribute with --class-attribute",
        most_frequent(counts.unknown_classes));
  }
  return fmt::format(
      "the rules leave them out ({}); name the attribute with --class-attribute or the layer with --layer",
      rules.describe());
}

}  // namespace roadfix
