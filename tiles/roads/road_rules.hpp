// Which road features are drawn, and how wide: one readable table, replaceable by the user.
// Classes and yes or no are compared without regard to case and outer blanks.
//
// The question behind every line of it is "does a camera above see a road here?". So footways, steps and cycle ways
// are left out (too narrow at the cells of a map, and mostly beside a road), tracks are drawn, tunnels are not.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roadfix {

struct RoadRule {
  std::string road_class;  ///< value of the class attribute (`highway` in OpenStreetMap)
  double width_m = 0.0;    ///< of the carriageway, where the feature itself does not say it
  bool drawn = true;
};

enum class WidthUnit { kMetre, kFoot };

/// "7.5", "7,5 m", "24 ft", "24'", "24'6\"", in any case; `unit` is that of numbers alone. nullopt for anything else or
/// a width outside 0.5..100 m.
std::optional<double> parse_width_m(std::string_view text, WidthUnit unit = WidthUnit::kMetre);

/// Value of a feature's attribute or tag; empty when it has none.
using TagLookup = std::function<std::string(std::string_view key)>;

/// The width that a feature itself states.
struct StatedWidth {
  std::string attribute;  ///< as it was asked for
  double width_m = 0.0;
};

class RoadRules {
 public:
  /// The built-in table, see road_rules.cpp.
  RoadRules();
  /// Lines "class width_m yes|no" in UTF-8; the class may hold blanks, '#' starts a comment. Replaces the table. Throws
  /// InvalidInput "rules-unreadable" with the line's number.
  static RoadRules parse(std::string_view text);

  /// Draws exactly these classes of the table, separated by commas. Throws InvalidInput "road-class-unknown".
  void select(std::string_view classes);
  /// "KEY", "KEY:m" or "KEY:ft": the unit of values that name none.
  void set_width_attribute(std::string_view text);
  void set_class_attribute(std::string key) { class_attribute_ = std::move(key); }
  /// Width of features that no rule and no attribute gives one; where set by the user it overrides the table.
  void set_width_m(double width_m) { width_m_ = width_m; }

  /// Width to draw the feature with, nullopt to leave it out. `classified` says that the layer has a class attribute:
  /// then a feature without class is no road; otherwise every line is one.
  std::optional<double> width_of(const TagLookup& tags, bool classified) const;
  /// nullopt where no attribute states a width, or the user's goes before it.
  std::optional<StatedWidth> stated_width(const TagLookup& tags) const;
  /// Of values of the attribute that name none.
  WidthUnit unit_of(std::string_view width_attribute) const;
  const std::string& class_attribute() const { return class_attribute_; }
  /// Without its unit; empty where the user named none.
  const std::string& width_attribute() const { return width_attribute_; }
  bool is_width_attribute(std::string_view attribute) const;
  /// Whether the table has a line for the class, drawn or not; of a list for one of its classes, the first counts.
  bool knows(std::string_view road_class) const { return find(road_class) != nullptr; }
  /// All of it in one line, for provenance and fingerprint.
  std::string describe() const;

 private:
  explicit RoadRules(std::vector<RoadRule> rules) : rules_(std::move(rules)) {}
  const RoadRule* find(std::string_view road_class) const;

  std::vector<RoadRule> rules_;
  std::string class_attribute_ = "highway";
  std::string width_attribute_;
  WidthUnit width_unit_ = WidthUnit::kMetre;
  std::optional<double> width_m_;
};

}  // namespace roadfix
