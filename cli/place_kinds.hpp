// What people are told of places before the flight.
#pragma once

#include <string>
#include <string_view>

#include "core/survey/localizability.hpp"

namespace roadfix::cli {

/// A line of a table: the kind, which share of so many `unit` (km, km2) of ground it has, and what it means.
std::string kind_line(PlaceKind kind, double share, double whole, std::string_view unit);

}  // namespace roadfix::cli
