#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "cli/feature_input.hpp"
#include "cli/map_notes.hpp"
#include "cli/number_checks.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "cli/unit_options.hpp"
#include "core/locate/match_poses.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/json_text.hpp"
#include "core/units/text.hpp"
#include "server/api/fix_json.hpp"

namespace roadfix::cli {
namespace {

struct MatchArguments {
  std::string map;
  std::string picture;
  FeatureInputOptions input;
  std::vector<std::string> poses;
  std::string poses_file;
  MatchOptions match;
  bool as_json = false;
};

/// "LAT,LON,HEADING"; `where` names the text in the message.
GeoPose parse_pose(std::string_view text, const std::string& where) {
  const std::vector<double> values = numbers_in(text, ',').value_or(std::vector<double>());
  if (values.size() != 3) {
    throw InvalidInput(
        "pose-unreadable",
        fmt::format("{}: \"{}\" is not a pose: write LATITUDE,LONGITUDE,HEADING in degrees", where, text));
  }
  if (std::abs(values[2]) > 360.0) {
    throw InvalidInput("pose-unreadable",
                       fmt::format("{}: the heading of \"{}\" is not within -360 to 360 degrees", where, text));
  }
  return {{values[0], values[1]}, Angle::degrees(values[2])};
}

/// One pose a line; empty lines and a first line of column names are skipped.
void read_poses(const std::string& path, std::vector<GeoPose>& poses) {
  const std::string text = read_named_file(path);
  int number = 0;
  for (std::string_view line : split(without_byte_order_mark(text), '\n')) {
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || (number == 1 && line.starts_with("lat"))) continue;
    poses.push_back(parse_pose(line, fmt::format("{} line {}", path, number)));
  }
}

void print_text(const std::vector<GeoPose>& poses, const std::vector<MatchScore>& scores) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const GeoPose& pose = poses[i];
    fmt::print("{:.6f} {:.6f} {:6.1f}  ", pose.position.lat_deg, pose.position.lon_deg, pose.heading.compass_degrees());
    if (scores[i].rho) {
      fmt::print("rho {:.4f}  P {:.4f}", *scores[i].rho, likelihood(*scores[i].rho));
    } else {
      fmt::print("rho undefined");
    }
    fmt::print("  observed cells {}\n", scores[i].observed_cells);
  }
}

void run_match(const MatchArguments& options) {
  std::vector<GeoPose> poses;
  for (const std::string& text : options.poses) poses.push_back(parse_pose(text, "--pose"));
  if (!options.poses_file.empty()) read_poses(options.poses_file, poses);
  if (poses.empty()) throw InvalidInput("poses-missing", "give at least one --pose LAT,LON,HEADING or a --poses file");
  const MapView view = view_with_notes(options.map);
  const api::Features input = FeatureInput(options.input, view).read(options.picture);
  MatchOptions match_options = options.match;
  match_options.stop = stop_on_signals();
  const std::vector<MatchScore> scores = match(view, input.map, poses, match_options);
  if (options.as_json) {
    fmt::print("{}\n", json_text(api::to_json(scores, view, input), 2));
  } else {
    print_text(poses, scores);
  }
}

}  // namespace

void add_match_command(CLI::App& app) {
  auto* command = app.add_subcommand("match", "Scores how well a feature map or a frame fits the map at given poses");
  command->footer("Example: roadfix match town.gpkg window.png --cell 2 --pose 57.70,11.97,45");
  const auto o = std::make_shared<MatchArguments>();
  command->add_option("map", o->map, "Map file (GeoPackage)")->required();
  command->add_option("input", o->picture, kInputMeaning)->required();
  add_feature_input_options(*command, o->input);
  command->add_option("--pose", o->poses, "LATITUDE,LONGITUDE,HEADING: degrees, heading from true north; repeatable");
  command->add_option("--poses", o->poses_file, "CSV file with one such pose per line");
  add_degrees_option(*command, "--heading-step", o->match.heading_step,
                     "Round headings to this many degrees and positions to cells: faster for many poses")
      ->check(between(0.0, 90.0));
  add_threads_option(*command, "--threads", o->match.threads, "Threads for scoring");
  command->add_flag("--json", o->as_json, "Answer as JSON");
  command->callback([o] { run_match(*o); });
}

}  // namespace roadfix::cli
