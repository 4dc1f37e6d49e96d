#include "cli/bench/frames_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::bench {
namespace {

[[noreturn]] void refuse(int line, const std::string& what) {
  throw InvalidInput("frames-csv", fmt::format("frames CSV, line {}: {}", line, what));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto end = text.find(separator);
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<std::size_t> place_of(const std::vector<std::string_view>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

struct Columns {
  std::array<std::size_t, 5> place{};
  std::optional<std::size_t> sequence;
  std::optional<std::size_t> time;
  static constexpr std::array<std::string_view, 5> kNames{"file", "lat", "lon", "heading_deg", "gsd_m"};

  static Columns of(std::string_view header) {
    const auto names = split(header, ',');
    Columns columns;
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      const auto found = place_of(names, kNames[i]);
      if (!found) refuse(1, fmt::format("the column '{}' is missing", kNames[i]));
      columns.place[i] = *found;
    }
    columns.sequence = place_of(names, "sequence");
    columns.time = place_of(names, "time_s");
    return columns;
  }
};

double number(std::string_view text, int line, std::string_view column, double low, double high) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high)) {
    refuse(line, fmt::format("{} is '{}'; it must be a number within {} to {}", column, text, low, high));
  }
  return value;
}

FrameTruth parse_line(std::string_view text, int line, const Columns& columns) {
  const auto fields = split(text, ',');
  if (fields.size() <= *std::ranges::max_element(columns.place)) refuse(line, "it has too few columns");
  const auto value = [&](std::size_t i, double low, double high) {
    return number(fields[columns.place[i]], line, Columns::kNames[i], low, high);
  };
  const auto optional_field = [&](const std::optional<std::size_t>& column) {
    return column && *column < fields.size() ? fields[*column] : std::string_view();
  };
  const std::string_view time = optional_field(columns.time);
  constexpr double kLongestS = 1e10;  // Unix times too
  return {std::string(fields[columns.place[0]]),
          {{value(1, -90.0, 90.0), value(2, -180.0, 180.0)}, Angle::degrees(value(3, -360.0, 360.0))},
          value(4, 1e-3, 1e3),
          std::string(optional_field(columns.sequence)),
          time.empty() ? std::nullopt : std::optional(number(time, line, "time_s", -kLongestS, kLongestS))};
}

}  // namespace

std::vector<FrameTruth> parse_frames_csv(std::string_view text) {
  std::vector<FrameTruth> frames;
  std::optional<Columns> columns;
  int line = 0;
  for (std::string_view row : split(without_byte_order_mark(text), '\n')) {
    ++line;
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (row.empty()) continue;
    if (!columns) {
      columns = Columns::of(row);
    } else {
      frames.push_back(parse_line(row, line, *columns));
    }
  }
  if (frames.empty()) refuse(line, "there are no frames");
  return frames;
}

}  // namespace roadfix::bench
