#include "cli/feature_input.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/detector_options.hpp"
#include "cli/limits.hpp"
#include "cli/number_checks.hpp"
#include "core/locate/told_frames.hpp"
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

/// `detector` is null for feature maps.
FeatureInput input_in(const std::string& path, const FeatureInputOptions& options, const RoadDetector* detector,
                      double map_cell_m) {
  if (detector == nullptr) {
    ToldScale told{options.cell_m, {}, {}};
    if (!options.nadir.empty()) told = {options.cell_m, options.nadir[0], options.nadir[1]};
    return {.features = feature_map_in(path, told)};
  }
  const SeenFrame frame = ground_seen(options.frame, path, *detector);
  return {.features = detect_features(*detector, frame.view, map_cell_m, options.seed),
          .camera_in_file = frame.camera_in_file};
}

FeatureInput features_in(const std::string& path, const FeatureInputOptions& options, const RoadDetector* detector,
                         double map_cell_m) {
  FeatureInput input = input_in(path, options, detector, map_cell_m);
  if (options.nadir_sigma_m) input.features.nadir_sigma_m = *options.nadir_sigma_m;
  return input;
}

FeatureInput all_features(const FeatureInputOptions& options, const RoadDetector* detector, double map_cell_m) {
  FeatureInput first = features_in(options.path, options, detector, map_cell_m);
  if (options.also.empty()) return first;
  if (options.also.size() >= kMaxFrames) {
    throw LimitExceeded("too-many-frames",
                        fmt::format("{} frames; at most {} are allowed", options.also.size() + 1, kMaxFrames));
  }
  std::vector<PlacedFeatures> parts{{std::move(first.features), {}}};
  for (const std::string& text : options.also) {
    const Another another = parse_also(text);
    parts.push_back({features_in(another.path, options, detector, map_cell_m).features, another.offset});
  }
  first.features = laid_together(parts, kMaxCells);
  first.own_frame = std::move(parts.front().features);
  return first;
}

}  // namespace

void add_feature_input_options(CLI::App& command, FeatureInputOptions& o) {
  command.add_option("input", o.path, "Feature map (PNG: grey = probability of road, alpha = observed) or frame")
      ->required();
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
          ->check(CLI::Range(-1e6, 1e6));
  for (CLI::Option* frame : add_frame_options(command, o.frame)) frame->excludes(cell)->excludes(nadir);
  command.add_option("--seed", o.seed, "Seed of detectors that use random numbers")
      ->capture_default_str()
      ->check(seed());
  add_detector_options(command, o.detector);
}

FeatureInput read_feature_input(const FeatureInputOptions& options, double map_cell_m) {
  require_frame_for(options.frame);
  if (!options.frame.given()) return all_features(options, nullptr, map_cell_m);
  const auto detector = make_detector(options.detector);
  const auto start = std::chrono::steady_clock::now();
  FeatureInput input = all_features(options, detector.get(), map_cell_m);
  input.detect_time = std::chrono::steady_clock::now() - start;
  return input;
}

}  // namespace roadfix::cli
