#include "cli/evaluation/frames_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::evaluation {
namespace {

constexpr double kAnyNumber = 1e10;  // Unix times too

[[noreturn]] void refuse(int line, const std::string& what) {
  throw InvalidInput("frames-csv", fmt::format("frames CSV, line {}: {}", line, what));
}

/// As spreadsheets write a field that holds a comma.
void refuse_quotes(std::string_view text, int line) {
  if (text.find('"') == std::string_view::npos) return;
  refuse(line, "it has quotes, which are not understood: write fields without them, and without commas");
}

/// The cells of a line by the names of their columns; empty where there is no such column or the line leaves it empty.
class Row {
 public:
  Row(const std::vector<std::string_view>& names, std::string_view text, int line)
      : names_(names), cells_(split(text, ',')), line_(line) {
    while (!cells_.empty() && cells_.back().empty()) cells_.pop_back();
    if (cells_.size() <= names_.size()) return;
    refuse(fmt::format("it has {} fields, and the header {}: numbers have a point, not a comma, before their decimals",
                       cells_.size(), names_.size()));
  }

  std::string_view text(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    const auto column = static_cast<std::size_t>(found - names_.begin());
    return found != names_.end() && column < cells_.size() ? cells_[column] : std::string_view();
  }
  bool has(std::string_view name) const { return !text(name).empty(); }

  double number(std::string_view name, double low, double high) const { return number(name, text(name), low, high); }
  std::optional<double> optional_number(std::string_view name, double low, double high) const {
    if (!has(name)) return std::nullopt;
    return number(name, low, high);
  }
  Angle angle(std::string_view name) const { return Angle::degrees(number(name, -360.0, 360.0)); }
  std::optional<Angle> optional_angle(std::string_view name) const {
    return has(name) ? std::optional(angle(name)) : std::nullopt;
  }
  std::vector<double> numbers(std::string_view name) const {
    std::vector<double> values;
    for (const std::string_view part : split(text(name), ' ')) {
      if (!part.empty()) values.push_back(number(name, part, -kAnyNumber, kAnyNumber));
    }
    return values;
  }
  [[noreturn]] void refuse(const std::string& what) const { evaluation::refuse(line_, what); }

 private:
  double number(std::string_view name, std::string_view text, double low, double high) const {
    const auto value = as_number<double>(text);
    if (value && *value >= low && *value <= high) return *value;
    refuse(fmt::format("{} is '{}'; it must be a number within {} to {}", name, text, low, high));
  }

  const std::vector<std::string_view>& names_;
  std::vector<std::string_view> cells_;
  int line_;
};

FrameCamera camera_of(const Row& row) {
  FrameCamera camera;
  camera.agl_m = row.optional_number("agl_m", 0.0, kAnyNumber).value_or(0.0);
  camera.horizontal_fov = row.optional_angle("fov_deg");
  camera.focal_px = row.optional_number("focal_px", -kAnyNumber, kAnyNumber);
  if (camera.horizontal_fov.has_value() == camera.focal_px.has_value()) {
    row.refuse("agl_m and alt_m need either fov_deg or focal_px");
  }
  camera.roll = row.optional_angle("roll_deg");
  camera.pitch = row.optional_angle("pitch_deg");
  if (const auto sigma = row.optional_number("attitude_sigma_deg", 0.0, kLargestAttitudeSigma.degrees())) {
    camera.attitude_sigma = Angle::degrees(*sigma);
  }
  if (row.has("principal_px")) {
    const std::vector<double> principal = row.numbers("principal_px");
    if (principal.size() != 2) row.refuse("principal_px must be two numbers with a blank between");
    camera.principal_px.emplace(principal[0], principal[1]);
  }
  if (row.has("lens")) {
    const std::string_view lens = row.text("lens");
    if (lens != "perspective" && lens != "fisheye") {
      row.refuse(fmt::format("lens is '{}'; it must be perspective or fisheye", lens));
    }
    if (lens == "fisheye") camera.lens = LensModel::kFisheye;
  }
  camera.distortion = row.numbers("distortion");
  return camera;
}

FrameTruth frame_of(const Row& row) {
  if (!row.has("file")) row.refuse("the column 'file' is empty");
  FrameTruth frame;
  frame.file = std::string(row.text("file"));
  frame.pose = {{row.number("lat", -90.0, 90.0), row.number("lon", -180.0, 180.0)}, row.angle("heading_deg")};
  constexpr std::array kSizes{"gsd_m", "agl_m", "alt_m"};
  if (std::ranges::count_if(kSizes, [&](const char* name) { return row.has(name); }) != 1) {
    row.refuse(
        "give gsd_m for a frame seen straight from above, or for any other either agl_m or alt_m, with fov_deg or "
        "focal_px");
  }
  frame.alt_m = row.optional_number("alt_m", -kAnyNumber, kAnyNumber);
  if (row.has("gsd_m")) {
    frame.view = StraightDown{row.number("gsd_m", 1e-3, 1e3)};
  } else {
    frame.view = camera_of(row);
  }
  frame.sequence = std::string(row.text("sequence"));
  frame.time_s = row.optional_number("time_s", -kAnyNumber, kAnyNumber);
  return frame;
}

std::vector<std::string_view> names_in(std::string_view header) {
  std::vector<std::string_view> names = split(header, ',');
  const auto has = [&](std::string_view name) { return std::ranges::find(names, name) != names.end(); };
  for (const std::string_view name : names) {
    if (name.empty() || std::ranges::count(names, name) == 1) continue;
    refuse(1, fmt::format("the column '{}' is there twice", name));
  }
  for (const std::string_view name : {"file", "lat", "lon", "heading_deg"}) {
    if (has(name)) continue;
    refuse(1, fmt::format(
                  "the column '{}' is missing{}", name,
                  header.find_first_of(";\t") == std::string_view::npos ? "" : "; columns are separated by commas"));
  }
  if (!has("gsd_m") && !has("agl_m") && !has("alt_m")) {
    refuse(1, "there is neither a column 'gsd_m' nor 'agl_m' nor 'alt_m'");
  }
  return names;
}

}  // namespace

std::vector<FrameTruth> parse_frames_csv(std::string_view text) {
  std::vector<FrameTruth> frames;
  std::optional<std::vector<std::string_view>> names;
  int line = 0;
  for (std::string_view row : split(without_byte_order_mark(text), '\n')) {
    ++line;
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (row.find_first_not_of(", \t") == std::string_view::npos) continue;  // spreadsheets write empty rows, too
    refuse_quotes(row, line);
    if (!names) {
      names = names_in(row);
    } else {
      frames.push_back(frame_of(Row(*names, row, line)));
    }
  }
  if (frames.empty()) refuse(line, "there are no frames");
  return frames;
}

}  // namespace roadfix::evaluation
