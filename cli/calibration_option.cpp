#include "cli/calibration_option.hpp"

#include "core/units/error.hpp"
#include "core/units/file.hpp"

namespace roadfix::cli {

void add_calibration_option(CLI::App& command, std::string& file) {
  command.add_option(
      "--calibration", file,
      "Calibration of probabilities, written by bench --calibrate; default: learned from simulated frames");
}

std::shared_ptr<const Calibration> read_calibration(const std::string& file) {
  const std::string text = read_named_file(file);
  return said_of(file, [&] { return std::make_shared<const Calibration>(parse_calibration(text)); });
}

}  // namespace roadfix::cli
