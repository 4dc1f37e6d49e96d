#include "cli/command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/detector_options.hpp"
#include "core/detect/frame_image.hpp"
#include "core/detect/image_codec.hpp"
#include "core/units/error.hpp"

namespace roadfix::cli {
namespace {

struct DetectOptions {
  DetectorChoice detector;
  std::string image;
  std::string target;
  double gsd_m = 0.0;
  double cell_m = 2.0;
  std::uint64_t seed = 1;
  bool black_unseen = false;
  bool json = false;
};

constexpr std::int64_t kMaxPixels = 400'000'000;

std::vector<std::uint8_t> bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) {
    throw InvalidInput("image-missing", fmt::format("{} cannot be read", path));
  }
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw IoFailure("image-unwritable", fmt::format("{} cannot be written", path));
}

double mean_probability(const CellArray& cells) {
  double sum = 0.0;
  for (const Cell cell : cells.cells()) {
    if (is_observed(cell)) sum += probability(cell);
  }
  return cells.observed_count() == 0 ? 0.0 : sum / static_cast<double>(cells.observed_count());
}

void run_detect(const DetectOptions& options) {
  const auto detector = make_detector(options.detector);
  const auto bytes = bytes_of(options.image);
  const GroundImage frame = frame_image(decode_image(bytes, kMaxPixels), options.gsd_m,
                                        options.black_unseen ? Border::kBlackUnseen : Border::kSeen);
  const auto start = std::chrono::steady_clock::now();
  const CellArray cells = detector->detect(frame, options.cell_m, options.seed);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  write(options.target, encode_feature_map(cells));
  const nlohmann::json answer{{"feature_map", options.target},
                              {"cell_m", options.cell_m},
                              {"cols", cells.cols()},
                              {"rows", cells.rows()},
                              {"observed_cells", cells.observed_count()},
                              {"mean_probability", mean_probability(cells)},
                              {"detector", detector->describe()},
                              {"time_ms", time.count()}};
  if (options.json) {
    fmt::print("{}\n", answer.dump());
  } else {
    fmt::print("{}: {} x {} cells of {} m, {} observed, mean probability of road {:.3f}, {:.0f} ms\n{}\n",
               options.target, cells.cols(), cells.rows(), options.cell_m, cells.observed_count(),
               mean_probability(cells), time.count(), detector->describe());
  }
}

}  // namespace

void add_detect_command(CLI::App& app) {
  auto* command = app.add_subcommand("detect", "Detects the roads of one frame: a feature map as PNG");
  command->footer("Example: roadfix detect frame.png roads.png --gsd 0.5");
  const auto options = std::make_shared<DetectOptions>();
  command->add_option("image", options->image, "Frame: PNG or JPEG, seen straight from above")->required();
  command->add_option("target", options->target, "PNG to write: grey = probability, alpha = observed")->required();
  command->add_option("--gsd", options->gsd_m, "Metres per pixel of the frame")->required()->check(CLI::PositiveNumber);
  command->add_option("--cell", options->cell_m, "Cell size in metres")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed, "Of detectors that draw random numbers")->capture_default_str();
  command->add_flag("--black-unseen", options->black_unseen, "Black areas at the frame's rim were not seen");
  command->add_flag("--json", options->json, "Answer as JSON");
  add_detector_options(*command, options->detector);
  command->callback([options] { run_detect(*options); });
}

}  // namespace roadfix::cli
