// Which lines of road data are roads, how wide they are, and which ground they cover.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "tiles/roads/road_lines.hpp"
#include "tiles/roads/road_rules.hpp"

namespace roadfix::cli {

struct RoadArguments {
  VectorOptions lines;
  std::string rules_file;
  std::string classes;
  std::string class_attribute;
  std::string width_attribute;
  std::optional<double> width_m;
};

/// `arguments` must live as long as the command.
void add_road_options(CLI::App& command, RoadArguments& arguments);

/// Throws NotFound and InvalidInput about the table of --rules and the classes.
RoadRules rules_of(const RoadArguments& arguments);

/// Throws InvalidInput "option-without-effect" if it is `given`: it does nothing with the source, and `why`.
void refuse_option(bool given, const char* option, const std::string& source, const char* why);

/// The same of all that is about lines, where the source holds pixels: who gives --extent would get all of it.
void refuse_for_pixels(const RoadArguments& arguments, const std::string& source);

}  // namespace roadfix::cli
