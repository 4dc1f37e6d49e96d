#include "cli/ingest/road_options.hpp"

#include <fmt/format.h>

#include "cli/number_checks.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"

namespace roadfix::cli {

void add_road_options(CLI::App& command, RoadArguments& a) {
  command.add_option("--layer", a.lines.layer, "Only this layer of vector files");
  command.add_option("--extent", a.lines.extent,
                     "Ground that road lines cover: W,S,E,N in degrees, or a file with polygons (GeoJSON, .poly, ...)");
  command.add_option("--classes", a.classes, "Draw exactly these road classes, comma-separated");
  command.add_option("--rules", a.rules_file,
                     "Table of road classes in place of the built-in one: lines 'class width_m yes|no'");
  command.add_option("--class-attribute", a.class_attribute,
                     "Attribute with the road class; default: highway, fclass, type, class or road_class");
  command.add_option("--width-attribute", a.width_attribute,
                     "Attribute that holds the width in metres; NAME:ft if in feet");
  command.add_option("--width", a.width_m, "Width of all roads in metres")->check(between(0.5, 100.0));
}

RoadRules rules_of(const RoadArguments& arguments) {
  RoadRules rules;
  if (!arguments.rules_file.empty()) rules = RoadRules::parse(read_named_file(arguments.rules_file));
  if (!arguments.classes.empty()) rules.select(arguments.classes);
  if (!arguments.class_attribute.empty()) rules.set_class_attribute(arguments.class_attribute);
  if (!arguments.width_attribute.empty()) rules.set_width_attribute(arguments.width_attribute);
  if (arguments.width_m) rules.set_width_m(*arguments.width_m);
  return rules;
}

void refuse_option(bool given, const char* option, const std::string& source, const char* why) {
  if (!given) return;
  throw InvalidInput("option-without-effect", fmt::format("{} does nothing with {}: {}", option, source, why));
}

void refuse_for_pixels(const RoadArguments& a, const std::string& source) {
  refuse_option(!a.lines.extent.empty(), "--extent", source,
                "it says what ground lines cover, and these are pixels. To take a part of them, cut them before "
                "(gdalwarp -te)");
  constexpr const char* kPixels = "it is about road lines, and these are pixels";
  refuse_option(!a.lines.layer.empty(), "--layer", source, kPixels);
  refuse_option(!a.classes.empty(), "--classes", source, kPixels);
  refuse_option(!a.rules_file.empty(), "--rules", source, kPixels);
  refuse_option(!a.class_attribute.empty(), "--class-attribute", source, kPixels);
  refuse_option(!a.width_attribute.empty(), "--width-attribute", source, kPixels);
  refuse_option(a.width_m.has_value(), "--width", source, kPixels);
}

}  // namespace roadfix::cli
