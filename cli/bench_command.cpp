#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "cli/bench/calibrate.hpp"
#include "cli/bench/curves.hpp"
#include "cli/bench/honesty.hpp"
#include "cli/bench/quality.hpp"
#include "cli/bench/queries.hpp"
#include "cli/bench/run.hpp"
#include "cli/calibration_option.hpp"
#include "cli/command.hpp"
#include "cli/detector_options.hpp"
#include "cli/given_options.hpp"
#include "cli/number_checks.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "core/detect/make_detector.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/json_text.hpp"

namespace roadfix::cli {
namespace {

struct BenchArguments {
  nlohmann::json given;  ///< given_options()
  std::string manifest;
  std::string json_file;
  std::string cache;
  std::optional<std::string> methods;
  std::string curves;
  std::string calibrate_file;
  std::string calibrate_headings_file;
  std::string calibration_file;
  DetectorChoice detector;
  std::optional<int> map_orientations;
  double cell_m = 2.0;
  bench::BenchOptions options;
};

bench::Manifest manifest_of(const BenchArguments& arguments) {
  bench::Manifest manifest = bench::read_manifest(arguments.manifest);
  return arguments.methods ? bench::with_methods(std::move(manifest), *arguments.methods) : manifest;
}

/// That which an environment variable names, unless it would depend on the folder that the command is started in.
std::optional<std::filesystem::path> folder_named_by(const char* variable) {
  const char* name = std::getenv(variable);
  std::filesystem::path folder(name != nullptr ? name : "");
  return folder.is_absolute() ? std::optional(std::move(folder)) : std::nullopt;
}

std::filesystem::path default_cache() {
  if (const auto caches = folder_named_by("XDG_CACHE_HOME")) return *caches / "roadfix";
  if (const auto home = folder_named_by("HOME")) return *home / ".cache" / "roadfix";
  return std::filesystem::temp_directory_path() / "roadfix";
}

/// One progress line for each task, in turn.
class TaskProgress {
 public:
  explicit TaskProgress(std::string unit) : unit_(std::move(unit)) {}
  void update(const std::string& task, std::int64_t done, std::int64_t total) {
    const std::lock_guard lock(mutex_);
    if (task != task_) progress_.emplace(task_ = task, unit_);
    progress_->update(done, total);
  }

 private:
  std::mutex mutex_;
  std::string unit_;
  std::string task_;
  std::optional<Progress> progress_;
};

/// Who read the pictures.
struct Readers {
  std::string maps;
  std::string frames;
};

nlohmann::json document(const BenchArguments& arguments, const Readers& readers,
                        const std::vector<bench::SetResult>& results, const bench::Honesty& honesty,
                        const std::vector<std::string>& left_out) {
  nlohmann::json sets = nlohmann::json::array();
  for (const auto& result : results) sets.push_back(to_json(result));
  return {{"roadfix", ROADFIX_VERSION},     {"options", arguments.given},
          {"manifest", arguments.manifest}, {"seed", arguments.options.seed},
          {"cell_m", arguments.cell_m},     {"detector", readers.frames},
          {"map_detector", readers.maps},   {"honesty", to_json(honesty)},
          {"left_out", left_out},           {"results", sets}};
}

/// What the calibration was learned from, for those who read the file.
nlohmann::json origin_of(const BenchArguments& arguments, const bench::Manifest& manifest,
                         const std::vector<std::string>& left_out) {
  nlohmann::json maps = nlohmann::json::array();
  for (const bench::ManifestMap& map : manifest.maps) maps.push_back(map.name);
  nlohmann::json origin{{"roadfix", ROADFIX_VERSION},
                        {"manifest", std::filesystem::path(arguments.manifest).filename().string()},
                        {"maps", maps},
                        {"seed", arguments.options.seed},
                        {"cell_m", arguments.cell_m}};
  if (!left_out.empty()) origin["left_out"] = left_out;
  return origin;
}

void write_json(const nlohmann::json& document, const std::string& file) {
  write_file(file, json_text(document, 1) + '\n');
}

void draw(const std::vector<bench::SetResult>& results, const bench::Honesty& honesty, const std::string& folder) {
  write_file(folder + "/reliability.svg", bench::reliability_svg(honesty));
  write_file(folder + "/answered.svg", bench::answered_svg(results));
  for (const bench::QualityProperty& property : bench::kQualityProperties) {
    if (const auto svg = bench::degraded_svg(results, property.value, std::string(property.axis)))
      write_file(fmt::format("{}/{}.svg", folder, property.curve), *svg);
  }
}

void learn(const BenchArguments& arguments, const nlohmann::json& origin, const std::vector<bench::Outcome>& outcomes,
           std::FILE* out) {
  const bench::CalibrationReport report = bench::learn_calibration(outcomes, *arguments.options.fix.calibration);
  write_json(bench::calibration_json(report, origin), arguments.calibrate_file);
  fmt::print(out, "learned from {} answers, {} of them right: {}\n", report.examples, report.right,
             arguments.calibrate_file);
  for (const std::string& note : bench::notes_on(report)) fmt::print(stderr, "note: {}\n", note);
}

void learn_headings(const BenchArguments& arguments, const nlohmann::json& origin,
                    const std::vector<bench::Outcome>& outcomes, std::FILE* out) {
  const std::string& file = arguments.calibrate_headings_file;
  const bench::HeadingScale learned = bench::learn_heading_scale(outcomes, *arguments.options.fix.calibration);
  write_json(bench::with_heading_scale(read_named_file(file), learned, origin), file);
  fmt::print(out, "learned from the headings of {} right answers: {}\n", learned.right, file);
}

/// Before hours are spent on answers that teach nothing.
void require_answers_to_learn_from(const BenchArguments& arguments, const bench::Manifest& manifest) {
  if (arguments.calibrate_file.empty() && arguments.calibrate_headings_file.empty()) return;
  if (std::ranges::find(manifest.methods, bench::MethodName::kRoads) != manifest.methods.end()) return;
  throw InvalidInput("calibration-too-few-examples",
                     "a calibration is learned from answers of 'roads', which is none of the methods: name it, too");
}

/// On `out`, and into the files that were asked for.
void report(const BenchArguments& arguments, const bench::Manifest& manifest, const Readers& readers,
            const std::vector<bench::SetResult>& results, const std::vector<std::string>& left_out, std::FILE* out) {
  fmt::print(out, "detector {}, of maps {}\nseed {}, cells of {} m\n\n{}", readers.frames, readers.maps,
             arguments.options.seed, arguments.cell_m, bench::to_table(results));
  const std::vector<bench::Outcome> outcomes = bench::road_outcomes(results);
  const bench::Honesty honesty = bench::honesty_of(outcomes);
  fmt::print(out, "\n{}", bench::to_text(honesty));
  if (!arguments.json_file.empty()) {
    write_json(document(arguments, readers, results, honesty, left_out), arguments.json_file);
  }
  if (!arguments.curves.empty()) draw(results, honesty, arguments.curves);
  const nlohmann::json origin = origin_of(arguments, manifest, left_out);
  if (!arguments.calibrate_file.empty()) learn(arguments, origin, outcomes, out);
  if (!arguments.calibrate_headings_file.empty()) learn_headings(arguments, origin, outcomes, out);
}

/// Of imagery.
std::unique_ptr<RoadDetector> detector_of_maps(const BenchArguments& arguments) {
  DetectorChoice choice = arguments.detector;
  choice.orientations = arguments.map_orientations;
  return make_map_detector(choice);
}

void run_bench(BenchArguments& arguments) {
  const bench::Manifest manifest = manifest_of(arguments);
  require_answers_to_learn_from(arguments, manifest);
  const std::initializer_list<std::filesystem::path> outputs = {arguments.json_file, arguments.calibrate_file,
                                                                arguments.calibrate_headings_file};
  require_apart(outputs, {arguments.manifest});
  require_writable(outputs);
  require_folder(arguments.curves);
  require_folder(arguments.options.pictures);
  if (!arguments.calibrate_headings_file.empty()) read_calibration(arguments.calibrate_headings_file);
  const Detectors detectors(arguments.detector);
  const std::unique_ptr<RoadDetector> map_detector = detector_of_maps(arguments);
  TaskProgress building("blocks");
  TaskProgress asking("queries");
  bench::BenchOptions& options = arguments.options;
  options.maps = {
      map_detector.get(),
      arguments.cell_m,
      options.seed,
      options.jobs,
      arguments.cache.empty() ? default_cache() : std::filesystem::path(arguments.cache),
      [&](const std::string& name, std::int64_t done, std::int64_t total) { building.update(name, done, total); },
      stop_on_signals(),
      ROADFIX_VERSION};
  options.detectors = &detectors;
  options.fix.search.deadline = Deadline(options.maps.stop);
  if (!arguments.calibration_file.empty()) options.fix.calibration = read_calibration(arguments.calibration_file);
  options.progress = [&](const std::string& task, std::int64_t done, std::int64_t total) {
    asking.update(task, done, total);
  };
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  const auto results = bench::run(manifest, options);
  const Readers readers{map_detector->describe(), detectors.describe()};
  report(arguments, manifest, readers, results, left_out, printed_beside(outputs));
  if (!left_out.empty()) {
    throw InvalidInput(
        "queries-left-out",
        fmt::format("{} sets of queries or frames could not be asked, the others have their result:\n  {}",
                    left_out.size(), fmt::join(left_out, "\n  ")));
  }
}

}  // namespace

void add_bench_command(CLI::App& app) {
  auto a = std::make_shared<BenchArguments>();
  CLI::App* command =
      app.add_subcommand("bench", "Measures accuracy over a manifest of maps and queries, compared with SIFT and ORB");
  command->footer("Example: roadfix bench city.bench.json --seed 1 --json out.json");
  command->add_option("manifest", a->manifest, "JSON file, see docs/bench.md")->required();
  command->add_option("--json", a->json_file, "Write figures and every query with truth, answer and error");
  command->add_option("--seed", a->options.seed, "Seed of the query poses and the detector")
      ->capture_default_str()
      ->check(seed());
  command->add_option("--limit", a->options.limit, "Queries of each set, at most; 0 = all")->check(not_negative());
  command->add_option_function<std::string>(
      "--methods", [a](const std::string& names) { a->methods = names; },
      "Only these of the manifest's methods, separated by commas");
  command->add_option("--curves", a->curves,
                      "Draw reliability and the share of answers, over footprint and quality, as SVG into this folder");
  command->add_option(
      "--pictures", a->options.pictures,
      "Draw every query into this folder: keypoint matches, roads before and after and their agreement");
  command->add_option("--calibrate", a->calibrate_file,
                      "Learn from the answers how reliable they are, and write a calibration to this file");
  command->add_option("--calibrate-headings", a->calibrate_headings_file,
                      "Learn from the answers how sure their headings are, and change that in this calibration");
  add_calibration_option(*command, a->calibration_file);
  command->add_option("--cell", a->cell_m, "Cell size of the maps in metres")->capture_default_str();
  command->add_option("--confidence", a->options.fix.confidence, "Minimum probability of a fix")
      ->capture_default_str()
      ->check(between(0.0, 1.0));
  add_threads_option(*command, "--jobs", a->options.jobs,
                     "Blocks or queries in progress at a time; 1 to measure times");
  command->add_option(
      "--map-cache", a->cache,
      "Folder for the built maps; default: the user's cache folder, without a home one for temporary files");
  add_detector_options(*command, a->detector);
  command
      ->add_option("--map-orientations", a->map_orientations,
                   fmt::format("As --orientations, for maps (default: {})", kMapOrientations))
      ->check(orientations());
  command->callback([a, command] {
    a->given = given_options(*command);
    run_bench(*a);
  });
}

}  // namespace roadfix::cli
