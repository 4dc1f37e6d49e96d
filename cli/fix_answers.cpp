#include "cli/fix_answers.hpp"

#include <fmt/format.h>

#include <string_view>

#include "server/api/fix_json.hpp"

namespace roadfix::cli {
namespace {

void print_mode(const FixMode& mode) {
  fmt::print(
      "  lat {:.6f} lon {:.6f}  heading {:.1f} +- {:.1f} deg  1 sigma {:.1f} x {:.1f} m  weight {:.3f}  rho {:.3f}\n",
      mode.pose.position.lat_deg, mode.pose.position.lon_deg, mode.pose.heading.compass_degrees(),
      mode.heading_sigma.degrees(), mode.ellipse.sigma_m[0], mode.ellipse.sigma_m[1], mode.weight, mode.rho);
  if (mode.agl_m) fmt::print("    {:.0f} m above the ground there\n", *mode.agl_m);
}

/// By RFC 4180: a name may hold commas, quotes and line breaks.
std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace

void print_text(const Fix& fix) {
  fmt::print("{}", api::to_string(fix.status));
  if (fix.status == FixStatus::kFix) {
    fmt::print("  probability {:.4f}\n", fix.probability);
    print_mode(fix.modes.front());
  } else {
    fmt::print(" ({}): {}\n", fix.reason, fix.explanation);
    if (!fix.modes.empty()) fmt::print("best places, not to be flown on:\n");
    for (const FixMode& mode : fix.modes) print_mode(mode);
  }
  if (fix.scales > 1) {
    fmt::print("tried {} sizes of the ground; {:.3f} times that of the feature map fits best\n", fix.scales,
               fix.modes.empty() ? 1.0 : fix.modes.front().scale);
  }
  if (!fix.modes.empty()) fmt::print("positions are WGS 84, headings from true north\n");
  fmt::print("searched {:.2f} km2 at {} headings in {:.0f} ms\n", fix.searched_km2, fix.headings,
             fix.search_time.count());
  if (!fix.complete)
    fmt::print("the time limit ended the search: {:.1f} % of the poses were examined\n", 100.0 * fix.searched_share);
  if (!fix.proof) return;
  if (fix.proof->complete) {
    fmt::print("proof complete: no other pose of the region fits better (cells of {} m, {} headings)\n",
               fix.proof->cell_m, fix.proof->headings);
  } else {
    fmt::print("proof incomplete: {:.1f} % of the poses cannot fit better; the rest score at most {:.3f}\n",
               100.0 * fix.proof->excluded_share, fix.proof->bound);
  }
}

std::string fix_columns() {
  return "file,status,lat,lon,heading_deg,sigma_major_m,sigma_minor_m,ellipse_heading_deg,heading_sigma_deg,"
         "probability,reason,map,map_version\n";
}

std::string row_of(const std::filesystem::path& picture, const Fix& fix) {
  std::string place = ",,,,,,";
  if (fix.status == FixStatus::kFix) {
    const FixMode& mode = fix.modes.front();
    place = fmt::format("{:.8f},{:.8f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f}", mode.pose.position.lat_deg,
                        mode.pose.position.lon_deg, mode.pose.heading.compass_degrees(), mode.ellipse.sigma_m[0],
                        mode.ellipse.sigma_m[1], mode.ellipse.heading.degrees(), mode.heading_sigma.degrees());
  }
  return fmt::format("{},{},{},{:.4f},{},{},{}\n", csv_cell(picture.string()), api::to_string(fix.status), place,
                     fix.probability, fix.reason, csv_cell(fix.map.name), fix.map.version);
}

}  // namespace roadfix::cli
