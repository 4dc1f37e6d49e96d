#include "cli/ingest/ingest_zone.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "cli/ingest/ingest_report.hpp"
#include "core/geodesy/utm.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/pipeline/open_source.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix::cli {
namespace {

constexpr double kCellM = 2.0;  // of a new map
constexpr double kFalseEastingM = 500e3;

UtmZone parsed_zone(const std::string& text) {
  const auto epsg = as_number<int>(std::string_view(text).substr(text.starts_with("EPSG:") ? 5 : 0));
  const std::optional<UtmZone> zone = epsg ? UtmZone::from_epsg(*epsg) : std::nullopt;
  if (!zone) {
    throw InvalidInput("zone-unknown",
                       fmt::format("--zone {}: write the EPSG code of a UTM zone on WGS 84, EPSG:32601 to "
                                   "32660 in the north, 32701 to 32760 in the south",
                                   text));
  }
  return *zone;
}

/// The cells of a northern zone end at the equator.
bool goes_south_of(const CellSource& source, UtmZone zone) {
  return zone.northern() && source.extent().min.north_m < 0.0;
}

/// By how much lengths on the plane exceed those on the ground, relative; Snyder, Map projections (1987), eq. 8-10,
/// without its term of the fourth order, which is 1e-5 at 500 km.
double stretch(double from_meridian_m) {
  constexpr double kCentralScale = 0.9996;
  constexpr double kEarthRadiusM = 6371e3;
  const double angle = from_meridian_m / (kCentralScale * kEarthRadiusM);
  return kCentralScale * (1.0 + angle * angle / 2.0) - 1.0;
}

bool is_about_place(const std::string& code) { return code == "crs-not-transformable" || code == "source-outside-map"; }

/// Throws where it is the zone that does not fit.
void refuse_another_zone(const SourceRequest& request, const MapSettings& settings) {
  const LatLon centre = centre_of_source(request);
  const UtmZone home = UtmZone::containing(centre);
  if (home.number() == settings.zone.number()) return;
  throw InvalidInput(
      "source-in-another-zone",
      fmt::format(
          "{}: lies at longitude {:.2f}, in UTM zone EPSG:{}, too far from EPSG:{} of the map to have a place "
          "on it. Ingest it into a map file of its own (another --map); or all sources into a new map with "
          "--zone EPSG:{}, which reaches 500 km to either side of longitude {} (lengths at its rims are "
          "{:.1f} % too long). If the file's reference system is wrong, give the right one with --crs; latitude and "
          "longitude may also be swapped in it",
          request.files.location, centre.lon_deg, home.epsg(), settings.zone.epsg(), home.epsg(),
          6 * home.number() - 183, 100.0 * stretch(kFalseEastingM)));
}

/// Throws in place of `error`, which names the file, where a folder holds other files that fit.
void refuse_several_zones(const SourceRequest& request, const InvalidInput& error) {
  if (request.files.paths.size() < 2) return;
  throw InvalidInput("source-in-several-zones",
                     fmt::format("{}. {} is one source, on one plane: where its files lie too far apart for that, move "
                                 "those of each place into a folder of their own, and ingest each folder into a map "
                                 "file of its own (another --map)",
                                 error.what(), request.files.location));
}

}  // namespace

MapSettings settings_of(const IngestArguments& arguments, const SourceRequest& first, const RoadDetector* detector) {
  if (const auto map = info_of(arguments.map)) {
    MapSettings existing = map->settings;
    if (arguments.cell_m) existing.cell_m = *arguments.cell_m;
    if (!arguments.zone.empty()) existing.zone = parsed_zone(arguments.zone);
    return existing;
  }
  const double cell_m = arguments.cell_m.value_or(kCellM);
  if (!arguments.zone.empty()) return {parsed_zone(arguments.zone), cell_m};
  return settings_of_new_map(first, cell_m, detector);
}

PlannedSource plan_source(const SourceRequest& request, const MapSettings& settings, const RoadDetector* detector) {
  PlannedSource planned;
  try {
    planned.cells = open_source(request, settings, detector);
    planned.blocks = std::ssize(plan_blocks(*planned.cells, request.files.name, settings));
    return planned;
  } catch (const InvalidInput& error) {
    if (is_about_place(error.code())) {
      refuse_another_zone(request, settings);
      refuse_several_zones(request, error);
    }
    throw;
  } catch (const LimitExceeded& error) {
    if (planned.cells)
      print_notes(request.files, planned.cells->summary().notes);  // of what makes it so large, for one
    if (request.files.paths.size() < 2) throw;
    throw LimitExceeded(error.code(), fmt::format("{}. Where the files of {} lie far apart, ingest those of each place "
                                                  "as a source of its own",
                                                  error.what(), request.files.location));
  }
}

std::vector<std::string> zone_notes(const CellSource& source, const MapSettings& settings) {
  constexpr double kWithinAnyZone = 0.001;  // at the border of a zone, on the equator
  std::vector<std::string> notes;
  const UtmZone zone = settings.zone;
  const GridBox extent = source.extent();
  if (goes_south_of(source, zone)) {
    notes.push_back(
        fmt::format("what lies south of the equator is left out, since the cells of EPSG:{} end there; a "
                    "new map with --zone EPSG:{} holds both sides",
                    zone.epsg(), zone.southern().epsg()));
  }
  const double far_m =
      std::max(std::abs(extent.min.east_m - kFalseEastingM), std::abs(extent.max.east_m - kFalseEastingM));
  if (far_m > kFalseEastingM) {
    notes.push_back(
        fmt::format("what lies more than 500 km from the central meridian of EPSG:{}, the zone of the map, "
                    "is left out; a map file of its own (another --map) holds it",
                    zone.epsg()));
  } else if (stretch(far_m) > kWithinAnyZone) {
    notes.push_back(
        fmt::format("it reaches {:.0f} km from the central meridian of EPSG:{}, the zone of the map, where "
                    "lengths are {:.2f} % too long; a map file of its own (another --map) for the zone "
                    "that it lies in has them right",
                    far_m / 1e3, zone.epsg(), 100.0 * stretch(far_m)));
  }
  return notes;
}

}  // namespace roadfix::cli
