// The option that replaces the shipped calibration by one of the user's own.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "core/locate/calibration.hpp"

namespace roadfix::cli {

void add_calibration_option(CLI::App& command, std::string& file);

/// Throws NotFound, and InvalidInput for what is no calibration.
std::shared_ptr<const Calibration> read_calibration(const std::string& file);

}  // namespace roadfix::cli
