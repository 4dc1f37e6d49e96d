#include "cli/boresight/boresight_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "server/api/json_parts.hpp"

namespace roadfix::cli {
namespace {

std::ptrdiff_t found_count(const Flight& flight) {
  return std::ranges::count_if(flight.frames, [](const FlightFrame& frame) { return frame.sighting.has_value(); });
}

std::string line(const char* name, const Estimate& estimate, int decimals, const char* unit,
                 const std::string& meaning) {
  return fmt::format("  {:<6}{:>+8.{}f} {:<3} +- {:.{}f}  {}\n", name, estimate.value, decimals, unit, estimate.sigma,
                     decimals, meaning);
}

/// More than two deviations, and more than anybody would notice.
bool matters(double value, double sigma, double least) { return std::abs(value) > std::max(2.0 * sigma, least); }

std::string reversed_text(const Boresight& found) {
  std::string text;
  const auto say = [&](const char* angle, const char* right) {
    text += fmt::format("**{} is told with the wrong sign**: positive is {}; what is above holds once that is mended\n",
                        angle, right);
  };
  if (found.is_roll_reversed) say("roll", "the right side down");
  if (found.is_pitch_reversed) say("pitch", "the nose up");
  return text;
}

/// Why something is not known better, and what would help.
std::string doubts_text(const Boresight& found) {
  constexpr double kWellKnownDeg = 0.5;
  if (std::max(found.pitch_deg.sigma, found.roll_deg.sigma) <= kWellKnownDeg) return "";
  std::string text = "pitch and roll are not known well: fly over the same ground with several headings";
  if (found.delay_s) text += " and at several speeds or heights, which tells them from a late or early picture";
  return text + "\n";
}

std::string size_text(const Estimate& size) {
  if (!matters(size.value - 1.0, size.sigma, 0.005)) return "of the ground, as told";
  return fmt::format("of the ground: heights times {:.3f}, or focal lengths divided by it", size.value);
}

std::string mount_text(const BoresightReport& report) {
  const Attitude mount = mounted(report.mounted, report.found.mount());
  std::string text =
      fmt::format("scripts/mavlink_steps: --camera-yaw {:.2f} --camera-pitch {:.2f} --camera-roll {:.2f}",
                  mount.yaw.degrees(), mount.pitch.degrees(), mount.roll.degrees());
  const auto& delay = report.found.delay_s;
  if (delay && matters(delay->value, delay->sigma, 0.02)) {
    text += fmt::format(", and {:.2f} s {} --delay", std::abs(delay->value), delay->value > 0.0 ? "more" : "less");
  }
  return text + "\n";
}

nlohmann::json json_of(const Estimate& estimate) { return {{"value", estimate.value}, {"sigma", estimate.sigma}}; }

nlohmann::json frames_json(const BoresightReport& report) {
  nlohmann::json frames = nlohmann::json::array();
  std::size_t sighting = 0;
  for (const FlightFrame& frame : report.flight.frames) {
    nlohmann::json row{{"file", frame.file.string()}, {"found", frame.sighting.has_value()}};
    if (frame.sighting) {
      const BodyOffset off = offset_from(frame.sighting->told, frame.sighting->found);
      row.update({{"ahead_m", off.forward_m},
                  {"right_m", off.right_m},
                  {"turn_deg", off.turn.degrees()},
                  {"size", frame.sighting->size},
                  {"used", static_cast<bool>(report.found.used[sighting++])}});
    } else {
      row["reason"] = frame.reason;
    }
    frames.push_back(std::move(row));
  }
  return frames;
}

}  // namespace

std::string boresight_text(const BoresightReport& report) {
  const Boresight& found = report.found;
  std::string text = fmt::format("{}: {} of {} frames found where they were told to be taken, {} used\n", report.csv,
                                 found_count(report.flight), report.flight.frames.size(), found.used_count());
  text += line("yaw", found.yaw_deg, 2, "deg", "the upper edge of the picture points so much farther to the right");
  text += line("pitch", found.pitch_deg, 2, "deg", "the camera looks so much farther ahead");
  text += line("roll", found.roll_deg, 2, "deg", "and its right side is so much farther down");
  if (found.delay_s) text += line("delay", *found.delay_s, 2, "s", "pictures were taken so much earlier");
  text += line("size", found.size, 3, "", size_text(found.size));
  text += fmt::format("places off (root mean square): {:.1f} m as told, {:.1f} m with these\n", found.told_rms_m,
                      found.corrected_rms_m);
  text += fmt::format("the map lies {:.1f} m east and {:.1f} m north of the told places\n", found.east_m.value,
                      found.north_m.value);
  text += fmt::format("roll and pitch are then known to {:.2f} degrees: --attitude-sigma, attitude_sigma_deg\n",
                      found.attitude_sigma.degrees());
  return text + reversed_text(found) + doubts_text(found) + mount_text(report);
}

nlohmann::json boresight_json(const BoresightReport& report) {
  const Boresight& found = report.found;
  const Attitude mount = mounted(report.mounted, found.mount());
  nlohmann::json json{
      {"map", api::to_json(report.map)},
      {"made_by", api::made_by()},
      {"yaw_deg", json_of(found.yaw_deg)},
      {"pitch_deg", json_of(found.pitch_deg)},
      {"roll_deg", json_of(found.roll_deg)},
      {"size", json_of(found.size)},
      {"map_east_m", json_of(found.east_m)},
      {"map_north_m", json_of(found.north_m)},
      {"roll_reversed", found.is_roll_reversed},
      {"pitch_reversed", found.is_pitch_reversed},
      {"attitude_sigma_deg", found.attitude_sigma.degrees()},
      {"told_rms_m", found.told_rms_m},
      {"corrected_rms_m", found.corrected_rms_m},
      {"mount",
       {{"yaw_deg", mount.yaw.degrees()}, {"pitch_deg", mount.pitch.degrees()}, {"roll_deg", mount.roll.degrees()}}},
      {"frames", frames_json(report)}};
  if (found.delay_s) json["delay_s"] = json_of(*found.delay_s);
  return json;
}

}  // namespace roadfix::cli
