#include "cli/bench/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>

#include "cli/bench/quality.hpp"
#include "core/search/search.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/json_file.hpp"
#include "core/units/text.hpp"

namespace roadfix::bench {
namespace {

const JsonFile kFile{"bench manifest", "manifest-field", "manifest-json", ""};

constexpr double kMaxFootprintM = 10'000.0;
constexpr double kMaxCount = 1e6;

constexpr std::array<Word<ManifestSource::As>, 3> kSources{{{"imagery", ManifestSource::As::kImagery},
                                                            {"roads", ManifestSource::As::kRoads},
                                                            {"invented", ManifestSource::As::kInvented}}};

constexpr std::array<Word<Border>, 1> kBorders{{{"black", Border::kBlackUnseen}}};

ManifestSource parse_source(const JsonField& field, const std::filesystem::path& directory) {
  const ManifestSource::As as = field.at("as").one_of(kSources);
  if (as != ManifestSource::As::kInvented) {
    field.allow_only({"path", "as"});
    return {directory / field.at("path").text(), as};
  }
  field.allow_only({"as", "seed", "side_m"});
  return {{},
          as,
          static_cast<std::uint64_t>(field.at("seed").whole_number(0.0, 1e9)),
          field.at("side_m").number(500.0, 8000.0)};
}

ManifestMap parse_map(const JsonField& field, const std::filesystem::path& directory) {
  field.allow_only({"name", "sources", "terrain"});
  ManifestMap map;
  map.name = field.at("name").text();
  for (const JsonField& source : field.at("sources").elements()) {
    map.sources.push_back(parse_source(source, directory));
  }
  if (map.sources.empty()) field.refuse("has no sources");
  if (!field.has("terrain")) return map;
  for (const JsonField& model : field.at("terrain").elements()) map.terrain.push_back(directory / model.text());
  if (map.terrain.empty()) field.at("terrain").refuse("names no elevation model");
  return map;
}

bool has_method(const Manifest& manifest, MethodName name) {
  return std::ranges::find(manifest.methods, name) != manifest.methods.end();
}

bool has_map(const Manifest& manifest, const std::string& name) {
  return std::ranges::any_of(manifest.maps, [&](const ManifestMap& map) { return map.name == name; });
}

double optional_number(const JsonField& field, const std::string& key, double low, double high) {
  return field.has(key) ? field.at(key).number(low, high) : 0.0;
}

Exclusion parse_exclusion(const JsonField& field) {
  field.allow_only({"top", "bottom", "left", "right"});
  const auto share = [&](const std::string& key) { return optional_number(field, key, 0.0, 0.9); };
  return {share("top"), share("bottom"), share("left"), share("right")};
}

void parse_property(const JsonField& field, const QualityProperty& property, QualityRange& range) {
  double& low = range.low.*property.value;
  double& high = range.high.*property.value;
  if (!field.is_array()) {
    low = high = field.number(0.0, property.max);
    return;
  }
  const auto bounds = field.elements();
  if (bounds.size() != 2) field.refuse("must be a number or [lowest, highest]");
  low = bounds[0].number(0.0, property.max);
  high = bounds[1].number(low, property.max);
}

QualityRange parse_noise(const JsonField& field) {
  std::vector<std::string_view> keys;
  for (const QualityProperty& property : kQualityProperties) keys.push_back(property.key);
  field.allow_only(keys);
  QualityRange range;
  for (const QualityProperty& property : kQualityProperties) {
    const std::string key(property.key);
    if (field.has(key)) parse_property(field.at(key), property, range);
  }
  return range;
}

void parse_footprint_and_count(const JsonField& field, QuerySet& set) {
  const JsonField footprint = field.at("footprint_m");
  const auto sides = footprint.elements();
  if (sides.size() != 2) footprint.refuse("must be [width, height] in metres");
  set.footprint = {sides[0].number(1.0, kMaxFootprintM), sides[1].number(1.0, kMaxFootprintM)};
  set.count = static_cast<int>(field.at("count").whole_number(1.0, kMaxCount));
}

void parse_prior(const JsonField& field, QuerySet& set) {
  if (!field.is_object()) {
    field.one_of({"map"});
    return;
  }
  field.allow_only({"radius_m", "beyond_m", "heading_range_deg", "scale_range"});
  if (field.has("heading_range_deg")) {
    set.prior_heading_range = Angle::degrees(field.at("heading_range_deg").number(0.0, 180.0));
  }
  if (field.has("scale_range")) set.prior_scale_range = field.at("scale_range").number(0.0, kMaxScaleRange);
  const bool of_place = field.has("radius_m") || field.has("beyond_m");
  if (!of_place && (set.prior_heading_range || field.has("scale_range"))) return;
  set.prior_radius_m = field.at("radius_m").number(1.0, 1e6);
  if (field.has("beyond_m")) set.prior_beyond_m = field.at("beyond_m").number(0.0, 1e6);
}

/// A field that would do nothing is a mistake about what the queries are.
void refuse_without_effect(const JsonField& field, QuerySet::Kind kind) {
  const auto refuse = [&](std::initializer_list<const char*> keys, const char* why) {
    for (const char* key : keys) {
      if (field.has(key)) field.at(key).refuse(why);
    }
  };
  if (kind != QuerySet::Kind::kSimulated) refuse({"from", "noise"}, "needs \"image\": null");
  if (kind != QuerySet::Kind::kFrames) refuse({"together", "unobserved"}, "needs 'frames'");
  if (kind == QuerySet::Kind::kFrames) {
    refuse({"count", "footprint_m", "exclude"}, "does nothing beside 'frames', which are all taken as they are");
  }
}

QuerySet parse_query_set(const JsonField& field, const Manifest& manifest, const std::filesystem::path& directory) {
  field.allow_only({"map", "image", "frames", "count", "footprint_m", "exclude", "prior", "noise", "unobserved", "from",
                    "elsewhere", "together"});
  QuerySet set;
  const auto map_name = [&](const std::string& key) {
    std::string name = field.at(key).text();
    if (!has_map(manifest, name)) {
      field.at(key).refuse(fmt::format("names the map '{}', which is not among the maps", name));
    }
    return name;
  };
  set.map = map_name("map");
  set.from = field.has("from") ? map_name("from") : set.map;
  if (field.has("elsewhere")) set.elsewhere = field.at("elsewhere").truth();
  if (field.has("image") == field.has("frames")) field.refuse("needs either 'image' or 'frames'");
  if (field.has("frames")) {
    set.kind = QuerySet::Kind::kFrames;
    set.path = directory / field.at("frames").text();
  } else {
    set.kind = field.at("image").is_null() ? QuerySet::Kind::kSimulated : QuerySet::Kind::kImage;
    if (set.kind == QuerySet::Kind::kImage) set.path = directory / field.at("image").text();
    parse_footprint_and_count(field, set);
  }
  refuse_without_effect(field, set.kind);
  if (set.elsewhere && set.kind == QuerySet::Kind::kSimulated && set.from == set.map) {
    field.at("elsewhere").refuse("needs \"from\": another map, since the ground of the map itself is on it");
  }
  if (field.has("exclude")) set.exclude = parse_exclusion(field.at("exclude"));
  if (field.has("noise")) set.noise = parse_noise(field.at("noise"));
  if (field.has("unobserved")) set.border = field.at("unobserved").one_of(kBorders);
  if (field.has("together")) set.together = static_cast<int>(field.at("together").whole_number(1.0, 64.0));
  if (field.has("prior")) parse_prior(field.at("prior"), set);
  return set;
}

}  // namespace

Manifest parse_manifest(std::string_view text, const std::filesystem::path& directory) {
  const nlohmann::json document = parse_json(text, kFile);
  const JsonField root(document, kFile);
  root.allow_only({"maps", "queries", "methods"});
  Manifest manifest;
  for (const JsonField& map : root.at("maps").elements()) {
    ManifestMap parsed = parse_map(map, directory);
    if (has_map(manifest, parsed.name)) map.at("name").refuse(fmt::format("is '{}', as of a map before", parsed.name));
    manifest.maps.push_back(std::move(parsed));
  }
  for (const JsonField& set : root.at("queries").elements())
    manifest.queries.push_back(parse_query_set(set, manifest, directory));
  if (root.has("methods")) {
    for (const JsonField& method : root.at("methods").elements()) {
      const MethodName name = method.one_of(kMethodNames);
      if (has_method(manifest, name)) method.refuse(fmt::format("is '{}', as one before", to_string(name)));
      manifest.methods.push_back(name);
    }
  } else {
    manifest.methods = {MethodName::kRoads};
  }
  if (manifest.queries.empty()) root.refuse("has no queries");
  if (manifest.methods.empty()) root.refuse("has no methods");
  return manifest;
}

Manifest read_manifest(const std::filesystem::path& file) {
  return parse_manifest(read_named_file(file), file.parent_path());
}

Manifest with_methods(Manifest manifest, std::string_view names) {
  std::vector<MethodName> wanted;
  for (const std::string_view name : split(names, ',')) {
    const auto method = value_of(kMethodNames, name);
    if (!method || !has_method(manifest, *method)) {
      std::vector<std::string_view> known;
      for (const MethodName one : manifest.methods) known.push_back(to_string(one));
      throw InvalidInput("method-unknown", fmt::format("--methods: the manifest has no method '{}'; it has {}", name,
                                                       fmt::join(known, ", ")));
    }
    wanted.push_back(*method);
  }
  std::erase_if(manifest.methods, [&](MethodName method) { return std::ranges::find(wanted, method) == wanted.end(); });
  return manifest;
}

}  // namespace roadfix::bench
