// What dates of options may be.
#pragma once

#include <CLI/CLI.hpp>

namespace roadfix::cli {

/// ISO 8601, as exact as it is known: a year, a month, a day, or a time of a day with its offset from UTC (or without
/// one). Only days that the calendar has.
CLI::Validator iso_date();

}  // namespace roadfix::cli
