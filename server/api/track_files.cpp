// Written as text: GDAL, whose types stay in tiles/, would have no times of points in its KML.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/units/json_text.hpp"
#include "server/api/geojson.hpp"
#include "server/api/track_claims.hpp"
#include "server/api/track_history.hpp"
#include "server/api/track_json.hpp"

namespace roadfix::api {
namespace {

constexpr std::string_view kXml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

/// What is no UTF-8 and no character of XML 1.0, as a name of a file may hold, is replaced.
std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : nlohmann::json::parse(json_text(text)).get<std::string>()) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c >= 0 && c < ' ' ? '?' : c;
    }
  }
  return result;
}

std::string title_of(const FlownTrack& track) { return fmt::format("Track {}", xml_text(track.id)); }

std::string source_of(const FlownTrack& track) {
  return fmt::format("Where roadfix {} found the UAV on the map {}, version {}. WGS 84, without heights",
                     ROADFIX_VERSION, xml_text(track.map.name), xml_text(track.map.version));
}

std::string told_of(const Claim& claim) {
  return fmt::format("heading {:.1f} degrees true, 1 sigma {:.1f} x {:.1f} m", claim.heading_deg, claim.sigma_m[0],
                     claim.sigma_m[1]);
}

/// Empty where the vehicle does not know the date.
std::string dated(std::string_view before, std::int64_t time_us, std::string_view after) {
  const std::string date = date_of(time_us);
  return date.empty() ? "" : fmt::format("{}{}{}", before, date, after);
}

std::vector<ClaimedStretch> stretches_of(std::span<const std::string> answers) {
  std::vector<ClaimedStretch> stretches(1);
  for (const std::string& text : answers) continue_with(stretches, stored_json(text));
  std::erase_if(stretches, [](const ClaimedStretch& stretch) { return stretch.empty(); });
  return stretches;
}

/// GPX knows no longitude of 180 degrees.
std::string gpx_point(const Claim& claim) {
  std::string lon = fmt::format("{:.7f}", claim.at.lon_deg);
  if (lon == "180.0000000") lon.insert(lon.begin(), '-');
  return fmt::format("<trkpt lat=\"{:.7f}\" lon=\"{}\">{}<cmt>{}</cmt></trkpt>\n", claim.at.lat_deg, lon,
                     dated("<time>", claim.time_us, "</time>"), told_of(claim));
}

std::string kml_place(LatLon at) { return fmt::format("{:.7f},{:.7f}", at.lon_deg, at.lat_deg); }

/// Of each part on one side of 180 degrees.
std::string kml_lines(const ClaimedStretch& stretch) {
  std::vector<LatLon> places;
  for (const Claim& claim : stretch) places.push_back(claim.at);
  std::string text;
  for (const auto& part : cut_at_180(places)) {
    text += "<LineString><tessellate>1</tessellate><coordinates>";
    for (const LatLon& at : part) text += kml_place(at) + ' ';
    text.back() = '<';
    text += "/coordinates></LineString>\n";
  }
  return text;
}

std::string kml_point(const Claim& claim) {
  return fmt::format(
      "<Placemark><name>{}</name><description>{}</description>{}<styleUrl>#step</styleUrl>"
      "<Point><coordinates>{}</coordinates></Point></Placemark>\n",
      claim.sequence, told_of(claim), dated("<TimeStamp><when>", claim.time_us, "</when></TimeStamp>"),
      kml_place(claim.at));
}

}  // namespace

std::string history_gpx(const FlownTrack& track, std::span<const std::string> answers) {
  std::string text(kXml);
  text += fmt::format(
      "<gpx version=\"1.1\" creator=\"roadfix {}\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n"
      "<trk>\n<name>{}</name>\n<desc>{}</desc>\n",
      ROADFIX_VERSION, title_of(track), source_of(track));
  for (const ClaimedStretch& stretch : stretches_of(answers)) {
    text += "<trkseg>\n";
    for (const Claim& claim : stretch) text += gpx_point(claim);
    text += "</trkseg>\n";
  }
  return text + "</trk>\n</gpx>\n";
}

std::string history_kml(const FlownTrack& track, std::span<const std::string> answers) {
  std::string lines;
  std::string points;
  for (const ClaimedStretch& stretch : stretches_of(answers)) {
    lines += kml_lines(stretch);
    for (const Claim& claim : stretch) points += kml_point(claim);
  }
  if (!lines.empty()) {
    lines = "<Placemark><name>Flight</name>\n<MultiGeometry>\n" + lines + "</MultiGeometry>\n</Placemark>\n";
  }
  return fmt::format(
      "{}<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n<name>{}</name>\n<description>{}</description>\n"
      "<Style id=\"step\"><IconStyle><scale>0.4</scale></IconStyle><LabelStyle><scale>0</scale></LabelStyle></Style>\n"
      "{}<Folder><name>Steps</name>\n{}</Folder>\n</Document>\n</kml>\n",
      kXml, title_of(track), source_of(track), lines, points);
}

}  // namespace roadfix::api
