#include "core/routes/waypoint_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/routes/mission_way.hpp"
#include "core/routes/route_json.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::routes {
namespace {

constexpr std::string_view kBegin = "QGC WPL";
constexpr std::size_t kNumbers = 12;
constexpr std::size_t kFrame = 2;
constexpr std::size_t kCommand = 3;
constexpr std::size_t kLatitude = 8;
constexpr std::size_t kHeight = 10;

std::string name_of(std::size_t line_number) { return fmt::format("line {}", line_number); }

/// The numbers of a line, between tabs or blanks, however many.
std::vector<double> numbers_of(std::string_view line, std::size_t line_number) {
  std::vector<double> numbers;
  while (!(line = trimmed(line)).empty()) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const auto number = as_number<double>(line.substr(0, end));
    if (!number || !std::isfinite(*number)) {
      throw InvalidInput(kRouteUnreadable, fmt::format("line {}: '{}' is no number: a waypoint has twelve", line_number,
                                                       line.substr(0, end)));
    }
    numbers.push_back(*number);
    line.remove_prefix(end);
  }
  return numbers;
}

LatLon position_in(const std::vector<double>& numbers, std::size_t line_number) {
  const LatLon place{numbers[kLatitude], numbers[kLatitude + 1]};
  if (std::abs(place.lat_deg) <= 90.0 && std::abs(place.lon_deg) <= 180.0) return place;
  throw InvalidInput(kRouteUnreadable,
                     fmt::format("line {}: latitude {} and longitude {} are no place: the ninth and tenth number are "
                                 "degrees, up to 90 and 180",
                                 line_number, place.lat_deg, place.lon_deg));
}

/// A whole number of a column, or one that stands for none.
std::int64_t code_in(double number) { return std::llround(std::clamp(number, -1.0, 65'535.0)); }

RoutePlace place_in(const std::vector<double>& numbers, std::size_t line_number) {
  if (std::abs(numbers[kHeight]) > kHighestM) {
    throw InvalidInput(kRouteUnreadable,
                       fmt::format("line {}: {} m are no height: the eleventh number is one, up to {:.0f} m",
                                   line_number, numbers[kHeight], kHighestM));
  }
  return {position_in(numbers, line_number), height_in_frame(code_in(numbers[kFrame]), numbers[kHeight]),
          name_of(line_number)};
}

void add_line(std::string_view line, std::size_t line_number, MissionWay& way) {
  if (line.starts_with('#')) return;  // MAVProxy and pymavlink take these lines for comments
  const std::vector<double> numbers = numbers_of(line, line_number);
  if (numbers.empty()) return;
  if (numbers.size() != kNumbers) {  // lists of version 100 have thirteen, in another order
    throw InvalidInput(kRouteUnreadable,
                       fmt::format("line {} has {} numbers: a waypoint has twelve", line_number, numbers.size()));
  }
  way.follow(code_in(numbers[kCommand]), name_of(line_number), [&] { return place_in(numbers, line_number); });
}

}  // namespace

bool is_waypoint_list(std::string_view text) { return text.starts_with(kBegin); }

Route parse_waypoint_list(std::string_view text) {
  MissionWay way = MissionWay::from_first_place();
  std::size_t line_number = 0;
  for (std::string_view line : split(text, '\n')) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (++line_number > 1) add_line(line, line_number, way);
  }
  return std::move(way).route();
}

}  // namespace roadfix::routes
