#include "tiles/roads/road_rules.hpp"

#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "tiles/roads/overture_flags.hpp"

namespace roadfix {
namespace {

// Widths of one line of OpenStreetMap: a dual carriageway is two lines. Classes after
// https://wiki.openstreetmap.org/wiki/Key:highway, widths of paved surface as in common design guides.
constexpr std::string_view kTable = R"(
# class          width_m  drawn
motorway         12       yes
motorway_link     7       yes
trunk            11       yes
trunk_link        7       yes
primary          10       yes
primary_link      6       yes
secondary         9       yes
secondary_link    6       yes
tertiary          8       yes
tertiary_link     6       yes
unclassified      6       yes
residential       6       yes
living_street     5       yes
pedestrian        6       yes
road              6       yes
service           4       yes
track             3       yes
track_grade1      3       yes   # of Geofabrik's Shapefiles: how firm the track is
track_grade2      3       yes
track_grade3      3       yes
track_grade4      3       yes
track_grade5      3       yes
unknown           6       yes   # of Geofabrik's Shapefiles and Overture: what OpenStreetMap calls road
busway            6       yes
bus_guideway      6       yes
minor             6       yes   # of OpenMapTiles: unclassified, residential and the like
street            6       yes   # of Mapbox: the same
street_limited    6       yes
raceway          10       yes
escape            5       yes
footway           2       no    # beside a road or under trees
path              1.5     no
cycleway          2.5     no
bridleway         2       no
steps             2       no
corridor          2       no    # inside buildings
elevator          2       no
via_ferrata       1       no
platform          3       no
proposed          0       no    # not there, or not there any more
planned           0       no
construction      0       no
abandoned         0       no
razed             0       no
disused           0       no
demolished        0       no
)";

constexpr std::array<std::string_view, 9> kInvisibleStates{
    "proposed", "planned", "construction", "abandoned", "razed", "disused", "demolished", "dismantled", "removed"};
constexpr std::array<std::string_view, 6> kFootClasses{"footway",  "path",       "steps",
                                                       "corridor", "pedestrian", "elevator"};
constexpr double kMostlyHidden = 0.5;
constexpr const char* kWidth = "width";
constexpr double kDefaultWidthM = 6.0;
constexpr double kLaneM = 3.25;
constexpr double kShouldersM = 1.0;
constexpr double kMaxLanes = 16.0;

constexpr std::string_view kBlank = " \t\r\n";

/// Shapefiles and office tables write "Primary", "PRIMARY" and "primary ", where OpenStreetMap writes "primary".
std::string plain(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return lower_case(text.substr(first, text.find_last_not_of(kBlank) - first + 1));
}

/// Of the end of a text without outer blanks, which it and the blanks before it are taken from.
std::string take_last_word(std::string& text) {
  const std::size_t start = text.find_last_of(kBlank) + 1;  // 0 where there is no blank
  std::string word = text.substr(start);
  text.erase(start);
  text.erase(text.find_last_not_of(kBlank) + 1);
  return word;
}

/// The class may hold blanks. nullopt where the line is none.
std::optional<RoadRule> rule_of(std::string line) {
  const std::string drawn = take_last_word(line);
  const auto width_m = as_number<double>(take_last_word(line));
  if (line.empty() || !width_m || !(*width_m >= 0.0 && *width_m <= 100.0) || (drawn != "yes" && drawn != "no")) {
    return std::nullopt;
  }
  return RoadRule{line, *width_m, drawn == "yes"};
}

/// Of the beginning of the text, which it and the spaces behind it are taken from; a comma is a decimal point.
std::optional<double> take_number(std::string_view& text) {
  std::string number;
  while (!text.empty() &&
         (std::isdigit(static_cast<unsigned char>(text.front())) != 0 || text.front() == '.' || text.front() == ',')) {
    number += text.front() == ',' ? '.' : text.front();
    text.remove_prefix(1);
  }
  text = trimmed(text);
  return as_number<double>(number);
}

/// Words of "['residential', 'unclassified']", as Python writes a list, and of "(2:residential,unclassified)", as OGR
/// does; none of other texts.
std::vector<std::string> words_of_list(std::string_view text) {
  constexpr std::string_view kBetween = "[](),:'\" ";
  std::vector<std::string> words;
  if (!text.starts_with('[') && !text.starts_with('(')) return words;
  while (true) {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(kBetween)));
    if (text.empty()) return words;
    const std::size_t end = std::min(text.size(), text.find_first_of(kBetween));
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

bool yes(const std::string& value) {
  const std::string word = plain(value);
  return !word.empty() && word != "no" && word != "n" && word != "0" && word != "false" && word != "f";
}

/// What nobody sees from above, or what does not exist.
bool hidden(const TagLookup& tags, std::string_view road_class) {
  if (yes(tags("tunnel")) || yes(tags("covered")) || yes(tags("indoor"))) return true;
  if (plain(tags("brunnel")) == "tunnel" || plain(tags("structure")) == "tunnel") return true;
  if (hidden_share(tags("road_flags")) >= kMostlyHidden) return true;
  const std::string location = plain(tags("location"));
  if (location == "underground" || location == "indoor") return true;
  const std::string level = tags("level");
  if (std::ranges::find(kFootClasses, road_class) != kFootClasses.end() && !level.empty() && level != "0") return true;
  return std::ranges::any_of(kInvisibleStates, [&](std::string_view state) { return plain(tags(state)) == "yes"; });
}

}  // namespace

RoadRules::RoadRules() : RoadRules(parse(kTable)) {}

RoadRules RoadRules::parse(std::string_view text) {
  RoadRules result{std::vector<RoadRule>{}};
  std::istringstream lines{std::string(without_byte_order_mark(text))};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string content = plain(line.substr(0, line.find('#')));
    if (content.empty()) continue;
    if (CPLIsUTF8(content.c_str(), static_cast<int>(content.size())) == FALSE) {
      throw InvalidInput("rules-unreadable",
                         fmt::format("line {} of the road rules is not in UTF-8, in which the classes of road data are "
                                     "read: save the file as UTF-8",
                                     number));
    }
    std::optional<RoadRule> rule = rule_of(content);
    if (!rule) {
      throw InvalidInput("rules-unreadable",
                         fmt::format("line {} of the road rules, '{}': write class, width in metres (0 "
                                     "to 100) and yes or no, for example 'residential 6 yes'",
                                     number, line));
    }
    result.rules_.push_back(*std::move(rule));
  }
  return result;
}

void RoadRules::select(std::string_view classes) {
  for (RoadRule& rule : rules_) rule.drawn = false;
  std::istringstream names{std::string(classes)};
  for (std::string name; std::getline(names, name, ',');) {
    const auto rule = std::ranges::find(rules_, plain(name), &RoadRule::road_class);
    if (rule == rules_.end()) {
      throw InvalidInput("road-class-unknown",
                         fmt::format("'{}' is not a class of the road rules; add it with --rules FILE", name));
    }
    rule->drawn = true;
    if (rule->width_m <= 0.0) rule->width_m = kDefaultWidthM;
  }
}

const RoadRule* RoadRules::find(std::string_view road_class) const {
  const std::string name = plain(road_class);
  const auto rule = std::ranges::find(rules_, name, &RoadRule::road_class);
  if (rule != rules_.end()) return &*rule;
  for (const std::string& word : words_of_list(name)) {
    const auto first = std::ranges::find(rules_, word, &RoadRule::road_class);
    if (first != rules_.end()) return &*first;
  }
  return nullptr;
}

std::optional<double> RoadRules::width_of(const TagLookup& tags, bool classified) const {
  const std::string road_class = classified ? plain(tags(class_attribute_)) : std::string();
  const RoadRule* rule = find(road_class);
  if (classified && (rule == nullptr || !rule->drawn)) return std::nullopt;
  if (hidden(tags, rule != nullptr ? rule->road_class : road_class)) return std::nullopt;
  if (const auto stated = stated_width(tags)) return stated->width_m;
  if (width_m_) return width_m_;
  const double lanes = std::strtod(tags("lanes").c_str(), nullptr);
  if (lanes >= 1.0 && lanes <= kMaxLanes) return lanes * kLaneM + kShouldersM;
  return rule != nullptr ? rule->width_m : kDefaultWidthM;
}

std::optional<StatedWidth> RoadRules::stated_width(const TagLookup& tags) const {
  if (!width_attribute_.empty()) {
    if (const auto width = parse_width_m(tags(width_attribute_), width_unit_)) return {{width_attribute_, *width}};
  }
  if (width_m_) return std::nullopt;
  const auto width = parse_width_m(tags(kWidth), unit_of(kWidth));
  return width ? std::optional(StatedWidth{kWidth, *width}) : std::nullopt;
}

void RoadRules::set_width_attribute(std::string_view text) {
  constexpr std::string_view kInFeet = ":ft";
  constexpr std::string_view kInMetres = ":m";
  width_unit_ = text.ends_with(kInFeet) ? WidthUnit::kFoot : WidthUnit::kMetre;
  if (text.ends_with(kInFeet)) text.remove_suffix(kInFeet.size());
  if (text.ends_with(kInMetres)) text.remove_suffix(kInMetres.size());
  width_attribute_ = text;
}

bool RoadRules::is_width_attribute(std::string_view attribute) const {
  return lower_case(attribute) == lower_case(width_attribute_);
}

WidthUnit RoadRules::unit_of(std::string_view width_attribute) const {
  return is_width_attribute(width_attribute) ? width_unit_ : WidthUnit::kMetre;
}

std::string RoadRules::describe() const {
  std::string text = fmt::format("class={}", class_attribute_);
  if (!width_attribute_.empty()) {
    text += fmt::format(" width-attribute={}{}", width_attribute_, width_unit_ == WidthUnit::kFoot ? ":ft" : "");
  }
  if (width_m_) text += fmt::format(" width={}", *width_m_);
  for (const RoadRule& rule : rules_) {
    if (rule.drawn) text += fmt::format(" {}={}", rule.road_class, rule.width_m);
  }
  return text;
}

std::optional<double> parse_width_m(std::string_view text, WidthUnit unit) {
  constexpr double kFootM = 0.3048;
  constexpr double kInchM = kFootM / 12.0;
  constexpr std::array<std::string_view, 4> kFeet{"ft", "ft.", "feet", "foot"};
  constexpr std::array<std::string_view, 5> kMetres{"m", "metres", "meters", "metre", "meter"};
  const std::string plain_text = plain(text);
  std::string_view rest = plain_text;
  const std::optional<double> number = take_number(rest);
  if (!number) return std::nullopt;
  double width_m = *number;
  if (rest.empty()) rest = unit == WidthUnit::kFoot ? kFeet.front() : kMetres.front();
  if (std::ranges::find(kFeet, rest) != kFeet.end()) {
    width_m *= kFootM;
  } else if (rest.starts_with('\'')) {  // 12' and 12'6"
    rest.remove_prefix(1);
    const std::optional<double> inches = rest.empty() ? 0.0 : take_number(rest);
    if (!inches || (!rest.empty() && rest != "\"")) return std::nullopt;
    width_m = *number * kFootM + *inches * kInchM;
  } else if (std::ranges::find(kMetres, rest) == kMetres.end()) {
    return std::nullopt;
  }
  return width_m >= 0.5 && width_m <= 100.0 ? std::optional(width_m) : std::nullopt;
}

}  // namespace roadfix
