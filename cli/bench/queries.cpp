#include "cli/bench/queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <variant>

#include "cli/bench/quality.hpp"
#include "cli/bench/query_poses.hpp"
#include "cli/bench/told_prior.hpp"
#include "cli/evaluation/frame_altitude.hpp"
#include "cli/evaluation/frame_files.hpp"
#include "cli/evaluation/random.hpp"
#include "core/detect/frame_camera.hpp"
#include "core/detect/frame_image.hpp"
#include "core/locate/altitude.hpp"
#include "core/locate/prior.hpp"
#include "core/units/error.hpp"
#include "tiles/imagery/read_orthoimage.hpp"

namespace roadfix::bench {
namespace {

using evaluation::FrameTruth;
using evaluation::Random;
using evaluation::stream;

/// The whole map at its finest level; benches run on maps of a city.
RoadGrid whole(const MapView& map) { return map.read(GridGeometry::covering(map.extent, map.cell_m)); }

Observed seen_by(const RoadGrid& grid) {
  return [&grid](GridPoint point) { return is_observed(grid.cell_at(point)); };
}

Observed seen_by(const Orthoimage& ortho) {
  return [&ortho](GridPoint point) { return sees(ortho, point); };
}

GridPoint anywhere_on(const MapView& map, Random& random) {
  return {uniform(random, map.extent.min.east_m, map.extent.max.east_m),
          uniform(random, map.extent.min.north_m, map.extent.max.north_m)};
}

GeoPose geo(const GridPose& pose, const UtmZone& zone) {
  return {zone.unproject(pose.position), zone.true_from_grid(pose.heading, pose.position)};
}

/// Between both, property by property.
FeatureQuality draw(const QualityRange& range, Random& random) {
  FeatureQuality quality;
  for (const QualityProperty& property : kQualityProperties) {
    quality.*property.value = uniform(random, range.low.*property.value, range.high.*property.value);
  }
  return quality;
}

std::optional<GeoPose> truth_of(const GridPose& pose, const QuerySet& set, const UtmZone& zone) {
  if (set.elsewhere) return std::nullopt;
  return geo(pose, zone);
}

int number_of(int wanted, const QueryDrawing& drawing) {
  return drawing.limit > 0 ? std::min(wanted, drawing.limit) : wanted;
}

/// Fills in what is seen at a pose.
using Show = std::function<void(const GridPose& pose, Random& random, Query& query)>;

/// Queries "NAME/0000" and so on at poses on the plane of the zone.
DrawnQueries at_poses(const PoseSampling& sampling, const UtmZone& zone, const std::string& name, const Show& show,
                      const QuerySet& set, const MapView& map, const QueryDrawing& drawing) {
  DrawnQueries drawn;
  for (int i = 0; i < number_of(set.count, drawing); ++i) {
    Random random = stream(drawing.seed, drawing.set, static_cast<std::uint64_t>(i));
    const auto pose = draw_pose(sampling, random);
    if (!pose) {
      return {{},
              {fmt::format("{}: no place was found where a footprint of {} x {} m lies inside the imagery, its "
                           "observed part and the map '{}'",
                           describe(set), set.footprint.width_m, set.footprint.height_m, set.map)}};
    }
    Query query;
    query.id = fmt::format("{}/{:04}", name, i);
    query.truth = truth_of(*pose, set, map.zone);
    show(*pose, random, query);
    tell_prior(query, set.elsewhere ? anywhere_on(map, random) : pose->position, geo(*pose, zone).heading, set, map,
               random);
    query.scale_range = set.prior_scale_range;
    drawn.queries.push_back(std::move(query));
  }
  return drawn;
}

DrawnQueries from_imagery(const QuerySet& set, const MapView& map, const QueryDrawing& drawing) {
  // Ground that is not on the map may lie anywhere on Earth.
  const UtmZone zone = set.elsewhere ? zone_of_image(set.path.string()) : map.zone;
  const Orthoimage ortho = read_orthoimage(set.path.string(), zone);
  const RoadGrid grid = whole(map);
  const Observed in_imagery = seen_by(ortho);
  const Observed in_map = set.elsewhere ? Observed([](GridPoint) { return true; }) : seen_by(grid);
  const PoseSampling sampling{without(ortho.box(), set.exclude), set.footprint,
                              [&](GridPoint p) { return in_imagery(p) && in_map(p); }};
  const auto show = [&](const GridPose& pose, Random& /*unused*/, Query& query) {
    query.view = std::make_shared<GroundView>(vertical_view(cut_out(ortho, pose, set.footprint, ortho.image.gsd_m)));
  };
  return at_poses(sampling, zone, set.path.stem().string(), show, set, map, drawing);
}

/// A place of one map can be found in the other only where both lie on one plane.
void require_same_plane(const QuerySet& set, const MapView& map, const MapView& from) {
  if (set.elsewhere || map.zone == from.zone) return;
  throw InvalidInput("map-of-another-zone", fmt::format("the maps '{}' and '{}' lie in different UTM zones: say "
                                                        "\"elsewhere\": true, or take maps of one place",
                                                        map.id.name, from.id.name));
}

DrawnQueries simulated(const QuerySet& set, const MapView& map, const MapView& from, const QueryDrawing& drawing) {
  require_same_plane(set, map, from);
  const RoadGrid grid = whole(from);
  const bool on_two_maps = !set.elsewhere && set.from != set.map;
  const RoadGrid searched = on_two_maps ? whole(map) : RoadGrid{};
  const Observed in_ground = seen_by(grid);
  const Observed in_map = on_two_maps ? seen_by(searched) : Observed([](GridPoint) { return true; });
  const auto cells = [&](double side_m) { return std::max(1, static_cast<int>(std::lround(side_m / from.cell_m))); };
  const PoseSampling sampling{without(from.extent, set.exclude), set.footprint,
                              [&](GridPoint p) { return in_ground(p) && in_map(p); }};
  const auto show = [&](const GridPose& pose, Random& random, Query& query) {
    const FeatureQuality quality = draw(set.noise, random);
    query.features =
        simulate_features(grid, pose, cells(set.footprint.width_m), cells(set.footprint.height_m), quality, random);
  };
  return at_poses(sampling, from.zone, "simulated", show, set, map, drawing);
}

SharedView seen_in(FrameTruth frame, const std::optional<Altitude>& altitude, const QuerySet& set,
                   const RoadDetector& detector) {
  if (altitude) std::get<FrameCamera>(frame.view).agl_m = altitude->agl_m;
  return std::make_shared<GroundView>(view_of(read_frame(set.path.parent_path(), frame, set.border), frame, detector));
}

/// Leaves the query without a view where the frame cannot be asked about; why is added to `left_out`.
void look_at(const FrameTruth& frame, Query& query, const QuerySet& set, const MapView& map,
             const RoadDetector& detector, std::vector<std::string>& left_out) {
  try {
    query.altitude = evaluation::altitude_of(frame, query.prior, map);
    query.view = seen_in(frame, query.altitude, set, detector);
  } catch (const Error& error) {
    if (!is_about_input(error)) throw;
    left_out.push_back(fmt::format("{}: {} [{}]", describe(set), error.what(), error.code()));
  }
}

/// Whether it was seen from above the ground that is below the reference, if that is as high everywhere.
bool is_above_ground(const std::optional<Altitude>& altitude, const std::optional<Altitude>& reference) {
  if (!altitude || !altitude->above_sea_m || !reference || !reference->above_sea_m) return true;
  return *altitude->above_sea_m > *reference->above_sea_m - reference->agl_m;
}

/// What a frame shows, and from where; nullptr where it cannot be read.
struct LookedAt {
  SharedView view;
  std::optional<Altitude> altitude;
};

/// `looked_at`: the frames so far, in their order, the one that is asked about last.
std::vector<EarlierFrame> frames_before(const std::vector<FrameTruth>& frames, const QuerySet& set, const UtmZone& zone,
                                        const std::vector<LookedAt>& looked_at) {
  std::vector<EarlierFrame> earlier;
  std::size_t index = looked_at.size() - 1;
  const FrameTruth& reference = frames[index];
  const auto& altitude = looked_at[index].altitude;
  while (index > 0 && static_cast<int>(earlier.size()) + 1 < set.together) {
    const FrameTruth& frame = frames[--index];
    const LookedAt& looked = looked_at[index];
    if (frame.sequence != reference.sequence || !looked.view) continue;  // flights may take turns in the file
    if (!is_above_ground(looked.altitude, altitude)) continue;
    const BodyOffset offset = offset_from(on_grid(reference.pose, zone), on_grid(frame.pose, zone));
    earlier.push_back({looked.view, offset, looked.altitude});
  }
  return earlier;
}

/// Some frames of a flight may lie beyond the map. Where all do, or one lies on another continent, latitude and
/// longitude were mixed up, or the maps.
void require_places_near(const MapView& map, const std::vector<FrameTruth>& frames, const QuerySet& set) {
  if (set.elsewhere) return;
  const auto place = [&](const FrameTruth& frame) { return map.zone.project_if_defined(frame.pose.position); };
  const auto in_zone = [&](const FrameTruth& frame) { return place(frame).has_value(); };
  const auto on_map = [&](const FrameTruth& frame) { return in_zone(frame) && map.extent.contains(*place(frame)); };
  const auto described = [](const FrameTruth& frame) {
    const LatLon at = frame.pose.position;
    return fmt::format("{} at latitude {} and longitude {}", frame.file.string(), at.lat_deg, at.lon_deg);
  };
  constexpr const char* kAdvice = "correct these columns, name the map of the place, or say \"elsewhere\": true";
  if (std::ranges::none_of(frames, on_map)) {
    throw InvalidInput("frames-outside-map",
                       fmt::format("{}: none of its frames lies on the map '{}', the first one, {}: {}",
                                   set.path.string(), map.id.name, described(frames.front()), kAdvice));
  }
  const auto far = std::ranges::find_if_not(frames, in_zone);
  if (far == frames.end()) return;
  throw InvalidInput("position-outside-zone", fmt::format("{}: {} is too far from the UTM zone of the map '{}': {}",
                                                          set.path.string(), described(*far), map.id.name, kAdvice));
}

/// By which a frame that tells its height above the sea gets its size.
void require_heights(const MapView& map, const std::vector<FrameTruth>& frames, const QuerySet& set) {
  const auto told = std::ranges::find_if(frames, [](const FrameTruth& frame) { return frame.alt_m.has_value(); });
  if (told == frames.end()) return;
  if (!map.terrain) {
    throw InvalidInput("terrain-missing",
                       fmt::format("{}: {} has alt_m, and the map '{}' does not know how high its ground is: give "
                                   "agl_m, or name elevation models in the \"terrain\" of the map",
                                   set.path.string(), told->file.string(), map.id.name));
  }
  const auto other = std::ranges::find_if(frames, [](const FrameTruth& frame) { return !frame.alt_m; });
  if (set.together > 1 && other != frames.end()) {
    throw InvalidInput("frames-without-size",
                       fmt::format("{}: {} has alt_m and {} has not, so that nobody knows how much higher one of them "
                                   "was: give all of them alt_m, or leave out \"together\"",
                                   set.path.string(), told->file.string(), other->file.string()));
  }
}

DrawnQueries real_frames(const QuerySet& set, const MapView& map, const RoadDetector& detector,
                         const QueryDrawing& drawing) {
  const auto frames = evaluation::read_frames_csv(set.path);
  require_places_near(map, frames, set);
  require_heights(map, frames, set);
  DrawnQueries drawn;
  std::vector<LookedAt> looked_at;
  for (int i = 0; i < number_of(static_cast<int>(frames.size()), drawing); ++i) {
    const FrameTruth& frame = frames[static_cast<std::size_t>(i)];
    Random random = stream(drawing.seed, drawing.set, static_cast<std::uint64_t>(i));
    Query query;
    query.id = frame.file.string();
    if (!set.elsewhere) query.truth = frame.pose;
    tell_prior(query, set.elsewhere ? anywhere_on(map, random) : map.zone.project(frame.pose.position),
               frame.pose.heading, set, map, random);
    look_at(frame, query, set, map, detector, drawn.left_out);
    looked_at.push_back({query.view, query.altitude});
    if (!query.view) continue;
    query.scale_range = set.prior_scale_range;
    const UtmZone zone = set.elsewhere ? UtmZone::containing(frame.pose.position) : map.zone;
    query.earlier = frames_before(frames, set, zone, looked_at);
    drawn.queries.push_back(std::move(query));
  }
  return drawn;
}

/// ", 60 % erased, 0 to 4 m shifted"; empty where nothing is wrong.
std::string errors_of(const QualityRange& noise) {
  std::string words;
  for (const QualityProperty& property : kQualityProperties) {
    const double unit = property.words.starts_with('%') ? 100.0 : 1.0;
    const double low = unit * noise.low.*property.value;
    const double high = unit * noise.high.*property.value;
    if (high <= 0.0) continue;
    words += low == high ? fmt::format(", {:g}", low) : fmt::format(", {:g} to {:g}", low, high);
    words += fmt::format(" {}", property.words);
  }
  return words;
}

/// ", prior 500 m", ", prior 500 m wrong by 30 m, heading within 20 deg"; empty where nothing is known.
std::string prior_words(const QuerySet& set) {
  std::string words;
  if (set.prior_radius_m) words += fmt::format(", prior {} m", *set.prior_radius_m);
  if (set.prior_beyond_m) words += fmt::format(" wrong by {} m", *set.prior_beyond_m);
  if (set.prior_heading_range) words += fmt::format(", heading within {:.4g} deg", set.prior_heading_range->degrees());
  if (set.prior_scale_range > 0.0) words += fmt::format(", size within {:.4g} %", 100.0 * set.prior_scale_range);
  return words;
}

std::string ground_words(const QuerySet& set) {
  if (set.kind != QuerySet::Kind::kSimulated) return set.path.filename().string();
  return set.from == set.map ? "simulated" : fmt::format("simulated from {}", set.from);
}

}  // namespace

DrawnQueries make_queries(const QuerySet& set, const MapView& map, const MapView& from, const RoadDetector& detector,
                          const QueryDrawing& drawing) {
  switch (set.kind) {
    case QuerySet::Kind::kImage:
      return from_imagery(set, map, drawing);
    case QuerySet::Kind::kFrames:
      return real_frames(set, map, detector, drawing);
    case QuerySet::Kind::kSimulated:
      return simulated(set, map, from, drawing);
  }
  return {};
}

std::optional<FeatureQuality> common_quality(const QuerySet& set) {
  if (set.kind != QuerySet::Kind::kSimulated || set.noise.low != set.noise.high) return std::nullopt;
  return set.noise.low;
}

std::string describe(const QuerySet& set) {
  std::string words = ground_words(set);
  if (set.elsewhere) words += " elsewhere";
  if (set.kind != QuerySet::Kind::kFrames) {
    words += fmt::format(" {}x{} m", set.footprint.width_m, set.footprint.height_m);
  }
  if (set.together > 1) words += fmt::format(" {} together", set.together);
  return words + errors_of(set.noise) + prior_words(set);
}

}  // namespace roadfix::bench
