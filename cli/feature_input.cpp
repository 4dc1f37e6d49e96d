#include "cli/feature_input.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/detector_options.hpp"
#include "cli/limits.hpp"
#include "cli/map_notes.hpp"
#include "cli/number_checks.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::cli {
namespace {

struct Another {
  std::string path;
  BodyOffset offset;
};

[[noreturn]] void refuse_also(const std::string& text) {
  throw InvalidInput("also-unreadable", fmt::format("--also {}: write FILE,FORWARD,RIGHT,TURN: metres ahead and to the "
                                                    "right of the input's UAV, degrees turned to the right",
                                                    text));
}

/// The file's name may hold commas; the last three are the offset's.
Another parse_also(const std::string& text) {
  std::string_view rest = text;
  std::array<double, 3> values{};
  for (std::size_t i = values.size(); i-- > 0;) {
    const auto comma = rest.rfind(',');
    if (comma == std::string_view::npos) refuse_also(text);
    const auto number = as_number<double>(rest.substr(comma + 1));
    if (!number || !(std::abs(*number) < 1e6)) refuse_also(text);
    values[i] = *number;
    rest = rest.substr(0, comma);
  }
  if (rest.empty()) refuse_also(text);
  return {std::string(rest), {values[0], values[1], Angle::degrees(values[2])}};
}

}  // namespace

void add_feature_input_options(CLI::App& command, FeatureInputOptions& o) {
  command
      .add_option("--also", o.also,
                  "Another frame or feature map, taken FORWARD m ahead and RIGHT m to the right of the input's place, "
                  "TURN degrees to its right; repeatable")
      ->type_name("FILE,FORWARD,RIGHT,TURN")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  auto* cell =
      command
          .add_option("--cell,--cell-m", o.cell_m,
                      "The input is a feature map: its cell size in metres (those of detect tell it themselves)")
          ->check(positive());
  auto* nadir =
      command
          .add_option("--nadir", o.nadir,
                      "The point below the UAV in a feature map, in cells from its upper left corner (default: "
                      "as the feature map says, else its middle)")
          ->type_name("COL,ROW")
          ->delimiter(',')
          ->expected(2)
          ->check(between(-1e6, 1e6));
  for (CLI::Option* frame : add_frame_options(command, o.frame)) frame->excludes(cell)->excludes(nadir);
  add_detector_options(command, o.detector);
}

FeatureInput::FeatureInput(const FeatureInputOptions& options, const MapView& map) : options_(options), map_(map) {
  require_frame_for(options.frame);
  if (options.frame.given()) detector_ = detector_for(map, options.detector);
}

api::Features FeatureInput::read(const std::string& path, std::optional<double> takeoff_agl_m) {
  api::Features first = features_in(path, takeoff_agl_m);
  if (options_.also.empty()) return first;
  if (options_.also.size() >= kMaxFrames) {
    throw LimitExceeded("too-many-frames",
                        fmt::format("{} frames; at most {} are allowed", options_.also.size() + 1, kMaxFrames));
  }
  std::vector<api::OtherFeatures> others;
  for (const std::string& text : options_.also) {
    const Another another = parse_also(text);
    others.push_back({features_in(another.path, takeoff_agl_m), another.offset});
  }
  api::Features all = api::together(std::move(first), std::move(others), kMaxCells);
  for (const std::size_t number : api::frame_numbers(all.left_out)) {
    const std::string file = number == 1 ? path : parse_also(options_.also[number - 2]).path;
    fmt::print(stderr,
               "note: left out frame {}, {}: it contradicts the others where they show the same ground. Check the "
               "picture and its offset\n",
               number, file);
  }
  return all;
}

api::Features FeatureInput::features_in(const std::string& path, std::optional<double> takeoff_agl_m) {
  api::Features features;
  if (detector_ != nullptr) {
    FrameOptions frame = options_.frame;
    frame.takeoff_agl_m = takeoff_agl_m;
    features = api::detected(ground_seen(frame, path, *detector_), {*detector_, map_.cell_m});
  } else {
    features.map = feature_map_with_note(path);
  }
  if (options_.nadir_sigma_m) features.map.nadir_sigma_m = *options_.nadir_sigma_m;
  if (const auto told = options_.nadir_heading_sigma_deg) features.map.nadir_heading_sigma = Angle::degrees(*told);
  return features;
}

FeatureMap FeatureInput::feature_map_with_note(const std::string& path) {
  ToldScale told{options_.cell_m, {}, {}};
  if (!options_.nadir.empty()) told = {options_.cell_m, options_.nadir[0], options_.nadir[1]};
  FoundFeatureMap found = feature_map_in(path, told);
  if (!found.reader.empty() && readers_.insert(found.reader).second) {
    note_other_reader(path, found.reader, map_, options_.detector);
  }
  return std::move(found.map);
}

}  // namespace roadfix::cli
