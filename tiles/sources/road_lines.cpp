#include "tiles/sources/road_lines.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/shell_word.hpp"
#include "tiles/sources/road_geometry.hpp"
#include "tiles/sources/road_ground.hpp"
#include "tiles/sources/road_layer.hpp"
#include "tiles/sources/stated_extent.hpp"
#include "tiles/sources/vector_file.hpp"

namespace roadfix {
namespace {

std::size_t index_of(const std::string& road_class, RoadNetwork& network) {
  const auto found = std::ranges::find(network.classes, road_class);
  const auto index = static_cast<std::size_t>(found - network.classes.begin());
  if (found == network.classes.end()) network.classes.push_back(road_class);
  return index;
}

/// Takes down what is known of a layer once all its features were seen.
void add_layer(const RoadLayer& layer, const RoadRules& rules, const std::string& path, RoadParts& parts) {
  if (layer.lines() == 0) return;
  parts.lines += layer.lines();
  for (const auto& [name, count] : layer.unknown_classes()) parts.unknown_classes[name] += count;
  parts.without_class += layer.lines_without_class();
  if (!layer.tells_other_lines()) parts.roads_without_class += layer.lines_without_class();
  for (const auto& [name, widths] : layer.stated_widths()) {
    std::vector<double>& of_all = parts.network_of(layer).stated_widths[name];
    of_all.insert(of_all.end(), widths.begin(), widths.end());
  }
  if (!layer.classified()) {
    parts.plain_layers.try_emplace(layer.name(), path, layer.attributes());
    return;
  }
  parts.any_classified = true;
  if (layer.class_attribute() == rules.class_attribute()) return;
  RoadNetwork& network = parts.classified;
  if (network.class_attribute.empty()) network.class_attribute = layer.class_attribute();
  const std::string about = fmt::format("layer '{}' of ", layer.name());
  if (std::ranges::any_of(network.notes, [&](const auto& note) { return note.starts_with(about); })) return;
  network.notes.push_back(fmt::format("{}{}: the classes of its roads are taken from the attribute '{}'", about, path,
                                      layer.class_attribute()));
}

void add_file(const std::string& path, const VectorOptions& options, const RoadRules& rules, UtmZone zone,
              RoadParts& parts) {
  VectorFile file(path, options);
  parts.classified_before = parts.classified.lines.size();
  parts.plain_before = parts.plain.lines.size();
  const OGRSpatialReference plane = utm_reference(zone);
  std::map<const OGRLayer*, RoadLayer> layers;
  for (OGRLayer* layer : file.layers()) {
    parts.any_layer = true;
    const OGRSpatialReference crs = file.crs_of(*layer);
    if (parts.plain.crs.empty()) parts.plain.crs = parts.classified.crs = crs_name(crs);
    layers.emplace(layer, RoadLayer(*layer, transformation(crs, plane, path), rules));
  }
  file.for_each_feature([&](OGRLayer& of, OGRFeature& feature) {
    const auto found = layers.find(&of);
    const OGRGeometry* geometry = feature.GetGeometryRef();
    if (found == layers.end() || geometry == nullptr) return;
    ++parts.features;
    RoadLayer& layer = found->second;
    RoadNetwork& network = parts.network_of(layer);
    const std::optional<double> width = layer.see(feature);
    if (!width ||
        !add_geometry(*geometry, layer.to_plane(), {*width, index_of(layer.class_of(feature), network)}, network)) {
      ++network.left_out;
    }
  });
  for (OGRLayer* of : file.layers()) {
    const RoadLayer& layer = layers.at(of);
    refuse_degrees_as_metres(file, layer);
    add_layer(layer, rules, path, parts);
    add_datum_error(file, layer, zone, parts);
    if (options.extent.empty()) add_covered(file, layer, zone, parts);
  }
}

/// Where some layers tell roads apart, the lines of the others are rivers, railways or bus routes.
RoadNetwork join(RoadParts& parts, const RoadRules& rules) {
  RoadNetwork network = std::move(parts.any_classified ? parts.classified : parts.plain);
  const RoadNetwork& other = parts.any_classified ? parts.plain : parts.classified;
  network.left_out += other.left_out + static_cast<std::int64_t>(other.lines.size());
  for (const auto& [name, about] : parts.plain_layers) {
    const auto& [path, attributes] = about;
    network.notes.push_back(
        parts.any_classified
            ? fmt::format("layer '{}' of {}: no attribute '{}', by which other layers tell roads apart, so none of its "
                          "lines is drawn. --layer {} draws them",
                          name, path, rules.class_attribute(), shell_word(name))
            : fmt::format("layer '{}' of {}: no attribute '{}', so every line is drawn as a road; it has {}. "
                          "--class-attribute and --width-attribute tell roads apart",
                          name, path, rules.class_attribute(), attributes));
  }
  return network;
}

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
void note_unknown_classes(const RoadParts& parts, RoadNetwork& network) {
  constexpr double kWorthNoting = 0.02;
  std::int64_t unknown = 0;
  for (const auto& [name, count] : parts.unknown_classes) unknown += count;
  if (static_cast<double>(unknown) <= kWorthNoting * static_cast<double>(parts.lines)) return;
  network.notes.push_back(fmt::format(
      "{} of {} lines are not drawn, since the road rules do not know their classes: {}. --rules FILE gives "
      "widths to them; it replaces the built-in rules, so name all classes that are roads in it",
      unknown, parts.lines, most_frequent(parts.unknown_classes)));
}

std::string class_attribute_of(const RoadNetwork& network, const RoadRules& rules) {
  return network.class_attribute.empty() ? rules.class_attribute() : network.class_attribute;
}

/// Whoever draws roads by hand forgets an attribute now and then.
void note_roads_without_class(const RoadParts& parts, const RoadRules& rules, RoadNetwork& network) {
  if (parts.roads_without_class == 0) return;
  network.notes.push_back(
      fmt::format("{} of {} lines are not drawn, since their attribute '{}' is empty. If they are roads, fill it in",
                  parts.roads_without_class, parts.lines, class_attribute_of(network, rules)));
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

std::string why_none_is_drawn(const RoadParts& parts, const RoadNetwork& network, const RoadRules& rules) {
  if (parts.lines == 0) {
    return "none of them is a line; points and areas are not drawn, centrelines are. To use areas of road, burn them "
           "into a raster (gdal_rasterize -burn 255 -init 0 -ot Byte) and ingest that with --as roads";
  }
  if (parts.without_class == parts.lines) {
    return fmt::format("their attribute '{}' is empty; fill it in, or name another with --class-attribute",
                       class_attribute_of(network, rules));
  }
  if (!parts.unknown_classes.empty()) {
    return fmt::format(
        "the road rules do not know their classes, {}; give them widths with --rules FILE, which replaces the built-in "
        "rules, or name another attribute with --class-attribute",
        most_frequent(parts.unknown_classes));
  }
  return fmt::format(
      "the rules leave them out ({}); name the attribute with --class-attribute or the layer with --layer",
      rules.describe());
}

[[noreturn]] void refuse_layer(const std::string& path, const VectorOptions& options) {
  throw InvalidInput("layer-unknown",
                     fmt::format("{}: has no layer {}; it has {}", path,
                                 options.layer.empty() ? "with geometries" : fmt::format("'{}'", options.layer),
                                 VectorFile(path, options).layer_names()));
}

[[noreturn]] void refuse_empty(const std::string& path, const VectorOptions& options) {
  throw InvalidInput(
      "source-without-roads",
      fmt::format("{}: {} empty, no feature has a geometry. Export the roads again, with a selection or filter that "
                  "leaves some, and look at the result with ogrinfo -so -al",
                  path, options.layer.empty() ? "it is" : fmt::format("its layer '{}' is", options.layer)));
}

/// nullopt where the file has no layer or no feature to look at.
std::optional<LatLon> centre_of_file(VectorFile& file, const std::string& path) {
  for (OGRLayer* layer : file.layers()) {
    const std::optional<OGREnvelope> box = file.extent_of(*layer);
    if (!box) continue;
    refuse_degrees_as_metres(*box, file.crs_of(*layer), path);
    return centre_on_earth(*box, file.crs_of(*layer), path, "give the right one with --crs");
  }
  return std::nullopt;
}

}  // namespace

RoadNetwork read_road_network(const std::vector<std::string>& paths, const VectorOptions& options,
                              const RoadRules& rules, UtmZone zone) {
  RoadParts parts;
  for (const std::string& path : paths) add_file(path, options, rules, zone, parts);
  if (!parts.any_layer) refuse_layer(paths.front(), options);
  if (parts.features == 0) refuse_empty(paths.front(), options);
  RoadNetwork network = join(parts, rules);
  if (!options.extent.empty()) network.covered = read_extent(options.extent, zone);
  if (network.lines.empty() || network.covered.empty()) {
    throw InvalidInput("source-without-roads",
                       fmt::format("{}: none of its {} features is drawn as a road: {}", paths.front(),
                                   network.left_out, why_none_is_drawn(parts, network, rules)));
  }
  note_unknown_classes(parts, network);
  note_roads_without_class(parts, rules, network);
  note_widths(rules, network);
  return network;
}

LatLon centre_of_roads(const std::vector<std::string>& paths, const VectorOptions& options) {
  if (!options.extent.empty()) return centre_of_extent(options.extent);
  bool any_layer = false;
  for (const std::string& path : paths) {
    VectorFile file(path, options);
    any_layer = any_layer || !file.layers().empty();
    if (const std::optional<LatLon> centre = centre_of_file(file, path)) return *centre;
  }
  if (!any_layer) refuse_layer(paths.front(), options);
  refuse_empty(paths.front(), options);
}

}  // namespace roadfix
