// Options whose numbers have a unit: angles in degrees, times in seconds. `value` must live as long as the command, and
// may be an optional one.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/number_checks.hpp"
#include "core/units/angle.hpp"

namespace roadfix::cli {

/// `value` is an Angle.
template <typename Value>
CLI::Option* add_degrees_option(CLI::App& command, const std::string& name, Value& value, const std::string& what) {
  return command.add_option_function<double>(
      name, [&value](double degrees) { value = Angle::degrees(degrees); }, what);
}

/// `value` is of std::chrono::milliseconds, rounded up: a time above 0 stays one.
template <typename Value>
CLI::Option* add_seconds_option(CLI::App& command, const std::string& name, Value& value, const std::string& what) {
  return command.add_option_function<double>(
      name, [&value](double seconds) { value = milliseconds(seconds); }, what);
}

}  // namespace roadfix::cli
