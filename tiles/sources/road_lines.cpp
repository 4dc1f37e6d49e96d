#include "tiles/sources/road_lines.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/units/error.hpp"
#include "tiles/sources/osm_tags.hpp"
#include "tiles/sources/vector_file.hpp"

namespace roadfix {
namespace {

/// Attributes of one feature, those packed in hstore text included.
class FeatureTags {
 public:
  explicit FeatureTags(const OGRFeature& feature) : feature_(feature) {}

  std::string operator()(std::string_view key) {
    const int field = feature_.GetFieldIndex(std::string(key).c_str());
    if (field >= 0 && feature_.IsFieldSetAndNotNull(field) != 0) return feature_.GetFieldAsString(field);
    const int packed = feature_.GetFieldIndex("other_tags");
    if (packed < 0 || feature_.IsFieldSetAndNotNull(packed) == 0) return {};
    if (!tags_) tags_ = parse_hstore(feature_.GetFieldAsString(packed));
    const auto found = tags_->find(key);
    return found != tags_->end() ? found->second : std::string();
  }

 private:
  const OGRFeature& feature_;
  std::optional<std::map<std::string, std::string, std::less<>>> tags_;
};

bool add_line(const OGRLineString& line, OGRCoordinateTransformation& to_plane, double width_m, RoadNetwork& network) {
  const int count = line.getNumPoints();
  if (count < 2) return false;
  std::vector<double> x(static_cast<std::size_t>(count));
  std::vector<double> y(x.size());
  std::vector<int> good(x.size(), FALSE);
  for (int i = 0; i < count; ++i) {
    x[static_cast<std::size_t>(i)] = line.getX(i);
    y[static_cast<std::size_t>(i)] = line.getY(i);
  }
  to_plane.Transform(count, x.data(), y.data(), nullptr, good.data());
  const std::size_t first = network.points.size();
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (good[i] == FALSE || !std::isfinite(x[i]) || !std::isfinite(y[i])) {
      network.points.resize(first);
      return false;
    }
    network.points.push_back({x[i], y[i]});
  }
  network.lines.push_back({first, x.size(), width_m / 2.0});
  return true;
}

/// Every line of the geometry, however deep it is nested. False when it has none that could be placed.
bool add_geometry(const OGRGeometry& geometry, OGRCoordinateTransformation& to_plane, double width_m,
                  RoadNetwork& network) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbLineString) return add_line(*geometry.toLineString(), to_plane, width_m, network);
  if (type == wkbMultiLineString || type == wkbGeometryCollection) {
    bool any = false;
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) {
      any = add_geometry(*part, to_plane, width_m, network) || any;
    }
    return any;
  }
  if (OGR_GT_IsCurve(type) != FALSE) {
    const std::unique_ptr<OGRGeometry> straight(geometry.getLinearGeometry());
    return straight && wkbFlatten(straight->getGeometryType()) == wkbLineString &&
           add_line(*straight->toLineString(), to_plane, width_m, network);
  }
  return false;
}

struct LayerReader {
  TransformationPtr to_plane;
  RoadRules rules;
  bool classified = false;
  bool has_lines = false;
};

bool has_attribute(OGRLayer& layer, const std::string& name) {
  return layer.GetLayerDefn()->GetFieldIndex(name.c_str()) >= 0;
}

/// Whether at least half of the first values of the attribute are classes of the rules.
bool holds_classes(OGRLayer& layer, const std::string& attribute, const RoadRules& rules) {
  constexpr int kSample = 200;
  int values = 0;
  int known = 0;
  layer.ResetReading();
  for (int i = 0; i < kSample; ++i) {
    const std::unique_ptr<OGRFeature> feature(layer.GetNextFeature());
    if (!feature) break;
    const std::string value = feature->GetFieldAsString(attribute.c_str());
    if (value.empty()) continue;
    ++values;
    known += rules.knows(value) ? 1 : 0;
  }
  layer.ResetReading();
  return values > 0 && 2 * known >= values;
}

/// The attribute that the user named or that of OpenStreetMap, else one that other road data keep the same classes in.
std::string class_attribute_of(OGRLayer& layer, const RoadRules& rules) {
  const std::string& wanted = rules.class_attribute();
  if (has_attribute(layer, wanted) || wanted != RoadRules().class_attribute()) return wanted;
  for (const char* usual : {"fclass", "type", "class", "road_class"}) {
    if (has_attribute(layer, usual) && holds_classes(layer, usual, rules)) return usual;
  }
  return wanted;
}

LayerReader reader_of(OGRLayer& layer, TransformationPtr to_plane, const RoadRules& rules) {
  LayerReader reader{std::move(to_plane), rules, false, false};
  reader.rules.set_class_attribute(class_attribute_of(layer, rules));
  reader.classified = has_attribute(layer, reader.rules.class_attribute());
  return reader;
}

/// Tells how the lines of a layer were told apart where that was not what the rules say.
void note_classes(OGRLayer& layer, const LayerReader& reader, const RoadRules& rules, const std::string& path,
                  RoadNetwork& network) {
  if (!reader.has_lines || (reader.classified && reader.rules.class_attribute() == rules.class_attribute())) return;
  const std::string about = fmt::format("layer '{}' of ", layer.GetName());
  if (std::ranges::any_of(network.notes, [&](const auto& note) { return note.starts_with(about); })) return;
  if (reader.classified) {
    network.notes.push_back(fmt::format("{}{}: the classes of its roads are taken from the attribute '{}'", about, path,
                                        reader.rules.class_attribute()));
    if (network.class_attribute.empty()) network.class_attribute = reader.rules.class_attribute();
    return;
  }
  std::string names;
  const OGRFeatureDefn& definition = *layer.GetLayerDefn();
  for (int i = 0; i < definition.GetFieldCount(); ++i) {
    names += fmt::format("{}{}", i == 0 ? "" : ", ", definition.GetFieldDefn(i)->GetNameRef());
  }
  network.notes.push_back(
      fmt::format("{}{}: no attribute '{}', so every line is drawn as a road; it has {}. --class-attribute and "
                  "--width-attribute tell roads apart",
                  about, path, rules.class_attribute(), names.empty() ? "no attributes" : "the attributes " + names));
}

void add_file(const std::string& path, const VectorOptions& options, const RoadRules& rules, UtmZone zone,
              RoadNetwork& network) {
  VectorFile file(path, options);
  const OGRSpatialReference plane = utm_reference(zone);
  std::map<const OGRLayer*, LayerReader> readers;
  for (OGRLayer* layer : file.layers()) {
    const OGRSpatialReference crs = file.crs_of(*layer);
    if (network.crs.empty()) network.crs = crs_name(crs);
    readers.emplace(layer, reader_of(*layer, transformation(crs, plane, path), rules));
  }
  file.for_each_feature([&](OGRLayer& layer, OGRFeature& feature) {
    const auto found = readers.find(&layer);
    const OGRGeometry* geometry = feature.GetGeometryRef();
    if (found == readers.end() || geometry == nullptr) return;
    LayerReader& reader = found->second;
    reader.has_lines = reader.has_lines || geometry->getDimension() == 1;
    FeatureTags tags(feature);
    const std::optional<double> width = reader.rules.width_of(std::ref(tags), reader.classified);
    if (!width || !add_geometry(*geometry, *reader.to_plane, *width, network)) ++network.left_out;
  });
  for (OGRLayer* layer : file.layers()) note_classes(*layer, readers.at(layer), rules, path, network);
  if (!options.extent.empty()) return;
  for (OGRLayer* layer : file.layers()) {
    const LayerReader& reader = readers.at(layer);
    if (!reader.has_lines && !vector_tile_of(path)) continue;  // shops say nothing about roads
    const std::optional<OGREnvelope> box = file.extent_of(*layer);
    if (box) network.covered.push_back(box_on_plane(*box, *reader.to_plane, path));
  }
}

}  // namespace

RoadNetwork read_road_network(const std::vector<std::string>& paths, const VectorOptions& options,
                              const RoadRules& rules, UtmZone zone) {
  RoadNetwork network;
  for (const std::string& path : paths) add_file(path, options, rules, zone, network);
  if (!options.extent.empty()) network.covered = read_extent(options.extent, zone);
  if (network.lines.empty() || network.covered.empty()) {
    throw InvalidInput(
        "source-without-roads",
        fmt::format("{}: none of its {} features is drawn as a road by the rules ({}); name the attribute "
                    "with --class-attribute or the layer with --layer",
                    paths.front(), network.left_out, rules.describe()));
  }
  return network;
}

LatLon centre_of_roads(const std::string& path, const VectorOptions& options) {
  VectorFile file(path, options);
  for (OGRLayer* layer : file.layers()) {
    const std::optional<OGREnvelope> box = file.extent_of(*layer);
    if (!box) continue;
    const TransformationPtr to_earth = transformation(file.crs_of(*layer), wgs84_reference(), path);
    double lon = (box->MinX + box->MaxX) / 2.0;
    double lat = (box->MinY + box->MaxY) / 2.0;
    const GdalMessages messages;
    if (to_earth->Transform(1, &lon, &lat) == FALSE || !(std::abs(lat) <= 90.0) || !(std::abs(lon) <= 360.0)) {
      throw InvalidInput(
          "crs-not-transformable",
          fmt::format("{}: its coordinates have no place on Earth; if the reference system is wrong, give "
                      "the right one with --crs",
                      path));
    }
    return {lat, lon};
  }
  throw InvalidInput("source-without-roads", fmt::format("{}: holds no features", path));
}

}  // namespace roadfix
