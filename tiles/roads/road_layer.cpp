#include "tiles/roads/road_layer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "core/units/text.hpp"
#include "tiles/roads/osm_tags.hpp"
#include "tiles/roads/road_geometry.hpp"

namespace roadfix {
namespace {

/// What programs write into text attributes where there is nothing: Python's None and pandas' nan, databases' NULL.
bool stands_for_nothing(const std::string& value) {
  constexpr std::array<std::string_view, 6> kWords{"none", "null", "nan", "<na>", "<null>", "(null)"};
  return std::ranges::find(kWords, lower_case(value)) != kWords.end();
}

/// Attributes in which programs pack those tags that have none of their own.
constexpr std::array<std::string_view, 3> kPacked{"other_tags", "all_tags", "tags"};

/// Attributes of one feature, the packed ones included.
class FeatureTags {
 public:
  FeatureTags(const OGRFeature& feature, AttributePlaces& places) : feature_(feature), places_(places) {}

  std::string operator()(std::string_view key) {
    std::string value = as_it_stands(key);
    if (stands_for_nothing(value)) value.clear();
    return value;
  }

 private:
  std::string as_it_stands(std::string_view key) {
    const int field = places_(key);
    if (field >= 0 && feature_.IsFieldSetAndNotNull(field) != 0) return feature_.GetFieldAsString(field);
    if (!packed_) packed_ = packed();
    const auto found = packed_->find(key);
    return found != packed_->end() ? found->second : std::string();
  }

  TagMap packed() {
    TagMap tags;
    for (const std::string_view name : kPacked) {
      const int field = places_(name);
      if (field >= 0 && feature_.IsFieldSetAndNotNull(field) != 0) {
        tags.merge(parse_tags(feature_.GetFieldAsString(field)));
      }
    }
    return tags;
  }

  const OGRFeature& feature_;
  AttributePlaces& places_;
  std::optional<TagMap> packed_;
};

bool has_attribute(OGRLayer& layer, const std::string& name) {
  return layer.GetLayerDefn()->GetFieldIndex(name.c_str()) >= 0;
}

/// Whether a feature of the layer has the tag among its packed ones.
bool packs(OGRLayer& layer, const std::string& key) {
  if (std::ranges::none_of(kPacked, [&](std::string_view name) { return has_attribute(layer, std::string(name)); })) {
    return false;
  }
  AttributePlaces places(layer);
  const GdalMessages messages;
  bool found = false;
  layer.ResetReading();
  while (!found) {
    const std::unique_ptr<OGRFeature> feature(layer.GetNextFeature());
    if (!feature) break;
    found = !FeatureTags(*feature, places)(key).empty();
  }
  layer.ResetReading();
  return found;
}

/// Of the first values of the attribute that say something, the share that are classes: of the user's rules or of the
/// usual ones, since a table of a few classes makes no other attribute of it. 0 without values.
double share_of_classes(OGRLayer& layer, const std::string& attribute, const RoadRules& rules) {
  constexpr int kSample = 200;
  const RoadRules usual;
  int values = 0;
  int known = 0;
  AttributePlaces places(layer);
  const GdalMessages messages;
  layer.ResetReading();
  for (int i = 0; i < kSample; ++i) {
    const std::unique_ptr<OGRFeature> feature(layer.GetNextFeature());
    if (!feature) break;
    const std::string value = FeatureTags(*feature, places)(attribute);
    if (value.empty() || lower_case(value) == "unknown") continue;  // a word of many tables
    ++values;
    known += rules.knows(value) || usual.knows(value) ? 1 : 0;
  }
  layer.ResetReading();
  return values > 0 ? static_cast<double>(known) / values : 0.0;
}

/// The attribute that the user named or that of OpenStreetMap, packed or not, else one that other road data keep the
/// same classes in; nullopt where nothing tells roads apart.
std::optional<std::string> class_attribute_in(const VectorFile& file, OGRLayer& layer, const RoadRules& rules) {
  const std::string& wanted = rules.class_attribute();
  if (file.is_openstreetmap()) return wanted;  // any tag may be packed, and the layer alone may seem empty
  if (has_attribute(layer, wanted) || packs(layer, wanted)) return wanted;
  if (wanted != RoadRules().class_attribute()) return std::nullopt;
  struct Usual {
    const char* name;
    double enough;
  };
  // fclass is Geofabrik's name, for railways and rivers too; other programs call many things a type.
  for (const Usual& usual : {Usual{"fclass", 0.1}, {"type", 0.5}, {"class", 0.5}, {"road_class", 0.5}}) {
    if (has_attribute(layer, usual.name) && share_of_classes(layer, usual.name, rules) >= usual.enough) {
      return usual.name;
    }
  }
  return std::nullopt;
}

/// Whether an attribute could say of a line without a class that it is a river, a railway or the like.
bool tells_other_lines(OGRLayer& layer) {
  constexpr std::array<std::string_view, 13> kOthers{"aerialway", "barrier",  "boundary", "building", "landuse",
                                                     "leisure",   "man_made", "natural",  "power",    "railway",
                                                     "route",     "subtype",  "waterway"};
  const auto has = [&](std::string_view name) { return has_attribute(layer, std::string(name)); };
  return std::ranges::any_of(kPacked, has) || std::ranges::any_of(kOthers, has);
}

}  // namespace

int AttributePlaces::operator()(std::string_view name) {
  auto known = known_.find(name);
  if (known == known_.end()) {
    std::string text(name);
    const int place = definition_->GetFieldIndex(text.c_str());
    known = known_.emplace(std::move(text), place).first;
  }
  return known->second;
}

RoadLayer::RoadLayer(const VectorFile& file, OGRLayer& layer, TransformationPtr to_plane, const RoadRules& rules)
    : path_(file.path()),
      layer_(&layer),
      to_plane_(std::move(to_plane)),
      places_(layer),
      limits_(coordinate_limits(file.crs_of(layer))),
      rules_(rules),
      tells_other_lines_(tells_other_lines(layer)) {
  const std::optional<std::string> attribute = class_attribute_in(file, layer, rules);
  if (attribute) rules_.set_class_attribute(*attribute);
  classified_ = attribute.has_value();
}

std::string RoadLayer::attributes() const {
  std::string names;
  const OGRFeatureDefn& definition = *layer_->GetLayerDefn();
  for (int i = 0; i < definition.GetFieldCount(); ++i) {
    names += fmt::format("{}{}", i == 0 ? "the attributes " : ", ", definition.GetFieldDefn(i)->GetNameRef());
  }
  return names.empty() ? "no attributes" : names;
}

std::optional<OGREnvelope> RoadLayer::extent_seen() const {
  return seen_.IsInit() != 0 ? std::optional(seen_) : std::nullopt;
}

std::optional<DrawnFeature> RoadLayer::see(const OGRFeature& feature) {
  FeatureTags tags(feature, places_);
  if (feature.GetGeometryRef() == nullptr || feature.GetGeometryRef()->IsEmpty() != FALSE) {
    if (rules_.width_of(std::ref(tags), classified_)) ++counts_.without_geometry;
    return std::nullopt;
  }
  const OGRGeometry& geometry = *feature.GetGeometryRef();
  if (!holds_a_line(geometry)) {
    if (geometry.getDimension() == 2 && rules_.width_of(std::ref(tags), classified_)) ++areas_;
    return std::nullopt;
  }
  if (!limits_.hold(geometry)) {
    if (counts_.impossible++ == 0) {
      counts_.first_impossible = fmt::format("{} of layer '{}' of {}", feature.GetFID(), name(), path_);
    }
    return std::nullopt;
  }
  std::string road_class = classified_ ? tags(rules_.class_attribute()) : std::string();
  ++counts_.lines;
  if (!road_class.empty() && !rules_.knows(road_class)) ++counts_.unknown_classes[road_class];
  if (classified_ && road_class.empty()) {
    ++counts_.without_class;
    if (!tells_other_lines_) ++counts_.roads_without_class;
  }
  if (!classified_ || rules_.knows(road_class)) {
    OGREnvelope own;
    geometry.getEnvelope(&own);
    seen_.Merge(own);
  }
  const std::optional<double> width = rules_.width_of(std::ref(tags), classified_);
  if (!width) return std::nullopt;
  note_stated_width(feature, rules_.stated_width(std::ref(tags)));
  return DrawnFeature{*width, std::move(road_class)};
}

void RoadLayer::note_stated_width(const OGRFeature& feature, const std::optional<StatedWidth>& stated) {
  if (!stated) return;
  const int field = places_(stated->attribute);
  if (field >= 0) {
    stated_widths_[feature.GetFieldDefnRef(field)->GetNameRef()].push_back(stated->width_m);
  } else if (rules_.is_width_attribute(stated->attribute)) {
    stated_widths_[stated->attribute].push_back(stated->width_m);
  }
}

}  // namespace roadfix
