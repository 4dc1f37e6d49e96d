#include "cli/calibration_option.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "core/units/error.hpp"

namespace roadfix::cli {

void add_calibration_option(CLI::App& command, std::string& file) {
  command.add_option("--calibration", file,
                     "How sure answers may be, as bench --calibrate wrote it; default: learned on simulated frames");
}

std::shared_ptr<const Calibration> read_calibration(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw NotFound("calibration-missing", fmt::format("calibration file {} cannot be opened", file));
  return std::make_shared<const Calibration>(parse_calibration(std::string{std::istreambuf_iterator<char>(in), {}}));
}

}  // namespace roadfix::cli
