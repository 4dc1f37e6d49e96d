#include "cli/shift_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace roadfix::cli {

std::string directions_of(const SourceShift& shift) {
  const auto part = [](double metres, const char* positive, const char* negative) {
    return fmt::format("{:.0f} m to the {}", std::abs(metres), metres > 0.0 ? positive : negative);
  };
  if (shift.north_m == 0.0) return part(shift.east_m, "east", "west");
  const std::string north = part(shift.north_m, "north", "south");
  return shift.east_m == 0.0 ? north : part(shift.east_m, "east", "west") + " and " + north;
}

}  // namespace roadfix::cli
