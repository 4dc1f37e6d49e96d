#include "tiles/roads/road_lines.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/shell_word.hpp"
#include "tiles/roads/bare_rim.hpp"
#include "tiles/roads/files_progress.hpp"
#include "tiles/roads/road_geometry.hpp"
#include "tiles/roads/road_ground.hpp"
#include "tiles/roads/road_layer.hpp"
#include "tiles/roads/road_notes.hpp"
#include "tiles/roads/stated_extent.hpp"
#include "tiles/roads/vector_file.hpp"
#include "tiles/sources/coordinate_limits.hpp"

namespace roadfix {
namespace {

/// Of the layers that tell roads apart, or of those that do not.
struct RoadPart {
  RoadNetwork network;
  std::size_t lines_before = 0;  ///< of the files before the one that is read

  std::span<const RoadLine> lines_of_file() const { return std::span(network.lines).subspan(lines_before); }
};

/// What the files hold. Which part is drawn is known once all are read.
struct RoadParts {
  RoadPart classified;
  RoadPart plain;
  std::string crs;  ///< of the first layer
  bool any_layer = false;
  bool any_classified = false;
  std::int64_t features = 0;
  LineCounts counts;
  bool strays_noted = false;
  bool bare_rim_noted = false;
  /// Layers of lines without classes by name: the first file that has them, and their attributes.
  std::map<std::string, std::pair<std::string, std::string>> plain_layers;

  RoadPart& of(const RoadLayer& layer) { return layer.classified() ? classified : plain; }
};

std::size_t index_of(const std::string& road_class, RoadNetwork& network) {
  const auto found = std::ranges::find(network.classes, road_class);
  const auto index = static_cast<std::size_t>(found - network.classes.begin());
  if (found == network.classes.end()) network.classes.push_back(road_class);
  return index;
}

/// Takes down what is known of a layer once all its features were seen.
void add_layer(const RoadLayer& layer, const RoadRules& rules, const std::string& path, RoadParts& parts) {
  if (layer.counts().lines == 0) return;
  parts.of(layer).network.areas += layer.areas();
  parts.counts += layer.counts();
  for (const auto& [name, widths] : layer.stated_widths()) {
    std::vector<double>& of_all = parts.of(layer).network.stated_widths[name];
    of_all.insert(of_all.end(), widths.begin(), widths.end());
  }
  if (!layer.classified()) {
    parts.plain_layers.try_emplace(layer.name(), path, layer.attributes());
    return;
  }
  parts.any_classified = true;
  if (layer.class_attribute() == rules.class_attribute()) return;
  RoadNetwork& network = parts.classified.network;
  if (network.class_attribute.empty()) network.class_attribute = layer.class_attribute();
  const std::string about = fmt::format("layer '{}' of ", layer.name());
  if (std::ranges::any_of(network.notes, [&](const auto& note) { return note.starts_with(about); })) return;
  network.notes.push_back(fmt::format("{}{}: the classes of its roads are taken from the attribute '{}'", about, path,
                                      layer.class_attribute()));
}

void add_datum_error(PositionError error, RoadNetwork& network) {
  if (error.sigma_m <= network.datum_sigma_m) return;
  network.datum_sigma_m = error.sigma_m;
  network.notes.push_back(std::move(error.reason));
}

/// With a note, for the first file only, where a few roads stretch it or much of it is bare.
void add_ground(VectorFile& file, const RoadLayer& layer, UtmZone zone, RoadParts& parts) {
  RoadPart& part = parts.of(layer);
  const auto ground = ground_of(file, layer, part.network, part.lines_of_file(), zone);
  if (!ground) return;
  if (vector_tile_of(file.path())) {  // all of it was looked at for roads of either part
    for (RoadPart* either : {&parts.classified, &parts.plain}) either->network.covered.push_back(ground->covered);
    return;
  }
  part.network.covered.push_back(ground->covered);
  if (parts.strays_noted) return;
  std::optional<std::string> note = ground->strays;
  parts.strays_noted = note.has_value();
  if (!note && !parts.bare_rim_noted) {
    note = note_on_bare_rim(part.network, part.lines_of_file());
    parts.bare_rim_noted = note.has_value();
  }
  if (note) part.network.notes.push_back(fmt::format("{}: {}", file.path(), *note));
}

void add_file(const std::string& path, const VectorOptions& options, const RoadRules& rules, UtmZone zone,
              RoadParts& parts) {
  VectorFile file(path, options);
  for (RoadPart* part : {&parts.classified, &parts.plain}) part->lines_before = part->network.lines.size();
  const OGRSpatialReference plane = utm_reference(zone);
  std::map<const OGRLayer*, RoadLayer> layers;
  for (OGRLayer* layer : file.layers()) {
    parts.any_layer = true;
    const OGRSpatialReference crs = file.crs_of(*layer);
    if (parts.crs.empty()) parts.crs = crs_name(crs);
    layers.emplace(layer, RoadLayer(file, *layer, transformation(crs, plane, path), rules));
  }
  file.for_each_feature([&](OGRLayer& of, OGRFeature& feature) {
    const auto found = layers.find(&of);
    if (found == layers.end()) return;
    RoadLayer& layer = found->second;
    const std::optional<DrawnFeature> drawn = layer.see(feature);
    const OGRGeometry* geometry = feature.GetGeometryRef();
    if (geometry == nullptr) return;
    ++parts.features;
    RoadNetwork& network = parts.of(layer).network;
    if (!drawn ||
        !add_geometry(*geometry, layer.to_plane(), {drawn->width_m, index_of(drawn->road_class, network)}, network)) {
      ++network.left_out;
    }
  });
  for (OGRLayer* of : file.layers()) {
    const RoadLayer& layer = layers.at(of);
    refuse_as_nowhere(file, layer);
    require_likely_coordinates(file, layer);
    add_layer(layer, rules, path, parts);
    add_datum_error(datum_error_of(file, layer, zone), parts.of(layer).network);
    if (options.extent.empty()) add_ground(file, layer, zone, parts);
  }
}

/// Where some layers tell roads apart, the lines of the others are rivers, railways or bus routes.
RoadNetwork join(RoadParts& parts, const RoadRules& rules) {
  RoadNetwork network = std::move((parts.any_classified ? parts.classified : parts.plain).network);
  const RoadNetwork& other = (parts.any_classified ? parts.plain : parts.classified).network;
  network.crs = parts.crs;
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

/// Layers of an unknown type may.
bool may_hold_lines(OGRLayer& layer) {
  const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
  const auto is = [type](OGRwkbGeometryType kind) { return OGR_GT_IsSubClassOf(type, kind) != FALSE; };
  return !is(wkbPoint) && !is(wkbMultiPoint) && !is(wkbSurface) && !is(wkbMultiSurface);
}

/// Of its first layer, among those that may hold lines or among the others; nullopt where there is none, or no feature
/// to look at.
std::optional<LatLon> centre_of_file(VectorFile& file, const std::string& path, bool of_lines) {
  for (OGRLayer* layer : file.layers()) {
    if (may_hold_lines(*layer) != of_lines) continue;
    const std::optional<OGREnvelope> box = file.extent_of(*layer);
    if (!box) continue;
    require_likely_coordinates(*box, file.crs_of(*layer), path);
    return centre_on_earth(*box, file.crs_of(*layer), path, "give the right one with --crs");
  }
  return std::nullopt;
}

VectorOptions with_progress(VectorOptions options, OnProgress on_reading) {
  options.on_reading = std::move(on_reading);
  return options;
}

}  // namespace

RoadNetwork read_road_network(const std::vector<std::string>& paths, const VectorOptions& options,
                              const RoadRules& rules, UtmZone zone) {
  RoadParts parts;
  FilesProgress progress(paths, options.on_reading);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    add_file(paths[i], with_progress(options, progress.of(i)), rules, zone, parts);
  }
  if (!parts.any_layer) refuse_layer(paths.front(), options);
  if (parts.features == 0) refuse_empty(paths.front(), options);
  RoadNetwork network = join(parts, rules);
  if (!options.extent.empty()) network.covered = read_extent(options.extent, zone);
  if (network.lines.empty() || network.covered.empty()) {
    throw InvalidInput("source-without-roads",
                       fmt::format("{}: none of its {} features is drawn as a road: {}", paths.front(),
                                   network.left_out, why_none_is_drawn(parts.counts, network, rules)));
  }
  add_notes(parts.counts, rules, network);
  return network;
}

LatLon centre_of_roads(const std::vector<std::string>& paths, const VectorOptions& options) {
  if (!options.extent.empty()) return centre_of_extent(options.extent);
  FilesProgress progress(paths, options.on_reading);
  bool any_layer = false;
  for (const bool of_lines : {true, false}) {  // areas of countries, and points of interest, may lie anywhere
    for (std::size_t i = 0; i < paths.size(); ++i) {
      VectorFile file(paths[i], with_progress(options, progress.of(i)));
      any_layer = any_layer || !file.layers().empty();
      if (const std::optional<LatLon> centre = centre_of_file(file, paths[i], of_lines)) return *centre;
    }
  }
  if (!any_layer) refuse_layer(paths.front(), options);
  refuse_empty(paths.front(), options);
}

}  // namespace roadfix
