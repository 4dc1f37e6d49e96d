#include "tiles/world/world.hpp"

#include <string>
#include <utility>

#include "tiles/roads/road_lines.hpp"
#include "tiles/world/conditions.hpp"
#include "tiles/world/country.hpp"
#include "tiles/world/country_disaster.hpp"
#include "tiles/world/development.hpp"
#include "tiles/world/disaster.hpp"
#include "tiles/world/frames.hpp"
#include "tiles/world/furnishing.hpp"
#include "tiles/world/painter.hpp"
#include "tiles/world/picture_file.hpp"
#include "tiles/world/real_streets.hpp"
#include "tiles/world/road_truth.hpp"
#include "tiles/world/street_network.hpp"
#include "tiles/world/world_files.hpp"

namespace roadfix::world {
namespace {

/// Streams of random numbers, one for each part of a world.
enum Stream : std::uint64_t { kStreets = 1, kBuildings, kTrees, kTraffic, kDisaster, kFrames, kDays };

LatLon centre_of(const WorldSettings& settings) {
  if (settings.centre) return *settings.centre;
  return settings.roads.empty() ? kDefaultCentre : centre_of_roads(road_files(settings.roads), {});
}

Plan empty_plan(const Placement& placement) {
  Plan plan;
  plan.width_m = placement.cols * placement.gsd_m;
  plan.height_m = placement.rows * placement.gsd_m;
  return plan;
}

void lay_streets(Plan& plan, const WorldSettings& settings, const Placement& placement) {
  if (settings.roads.empty()) {
    Random random(settings.seed, kStreets);
    invent_streets(plan, random);
  } else {
    plan.streets = read_streets(settings.roads, placement);
  }
}

void fill_in(Plan& plan, Site& site, std::uint64_t seed) {
  Random building(seed, kBuildings);
  develop(plan, site, building);
  Random tree(seed, kTrees);
  plant(plan, site, tree);
  Random car(seed, kTraffic);
  plan.boxes = traffic(plan, car);
}

struct Plans {
  Plan before;
  Plan after;
};

Plans plans_of(const WorldSettings& settings, const Placement& placement) {
  Plan before = empty_plan(placement);
  Random shock(settings.seed, kDisaster);
  if (settings.land == Land::kCountry) {
    lay_out_country(before, settings.seed);
    Plan after = after_earthquake_in_country(before, settings.collapsed_share, shock);
    return {std::move(before), std::move(after)};
  }
  lay_streets(before, settings, placement);
  Site site(before);
  fill_in(before, site, settings.seed);
  Plan after = after_earthquake(before, site, settings.collapsed_share, shock);
  return {std::move(before), std::move(after)};
}

class Photographer {
 public:
  Photographer(const Placement& placement, std::uint64_t seed, const OnProgress& progress, std::stop_token stop)
      : placement_(placement), texture_(seed), progress_(progress), stop_(std::move(stop)) {}

  void photograph(const Plan& plan, const Conditions& conditions, const std::string& path) {
    PictureFile file(path, placement_);
    for (int row = 0; row < placement_.rows; row += kTilePx) {
      for (int col = 0; col < placement_.cols; col += kTilePx) {
        throw_if_stopped(stop_);
        const cv::Rect tile = cv::Rect(col, row, kTilePx, kTilePx) & cv::Rect(0, 0, placement_.cols, placement_.rows);
        file.write(tile.tl(), paint_tile(plan, conditions, texture_, tile, placement_.gsd_m));
        if (progress_) progress_(++done_, 2 * tiles());
      }
    }
    file.finish();
  }

 private:
  std::int64_t tiles() const {
    const auto across = [](int pixels) { return std::int64_t{(pixels + kTilePx - 1) / kTilePx}; };
    return across(placement_.cols) * across(placement_.rows);
  }

  const Placement& placement_;
  Texture texture_;
  const OnProgress& progress_;
  std::stop_token stop_;
  std::int64_t done_ = 0;
};

WorldReport report_of(const Plan& before, const Plan& after, const Placement& placement, int road_lines) {
  WorldReport report{.placement = placement, .road_lines = road_lines};
  for (const Street& street : before.streets) {
    for (const Polyline& line : clipped(street.line, before.width_m, before.height_m)) {
      report.road_km += length_m(line) / 1000.0;
    }
  }
  report.blocks = static_cast<int>(before.blocks.size());
  report.buildings = static_cast<int>(before.buildings.size());
  report.collapsed = static_cast<int>(after.debris.size());
  report.trees = static_cast<int>(before.trees.size());
  return report;
}

}  // namespace

WorldReport render_world(const WorldSettings& settings, const std::filesystem::path& folder, const OnProgress& progress,
                         const std::stop_token& stop) {
  check(settings);
  const Placement placement = place(settings, centre_of(settings));
  const auto [before, after] = plans_of(settings, placement);

  clear_folder(folder);
  Photographer photographer(placement, settings.seed, progress, stop);
  Random days(settings.seed, kDays);
  const Conditions day_before = settings.varied ? any_day(days, 1) : summer_before();
  const Conditions day_after = settings.varied ? any_day(days, 5) : winter_after();
  photographer.photograph(before, day_before, (folder / "pre.tif").string());
  photographer.photograph(after, day_after, (folder / "post.tif").string());
  const int lines = write_road_truth((folder / "roads.geojson").string(), before.streets, placement);
  Random pose(settings.seed, kFrames);
  const auto poses = draw_poses(settings, placement, pose);
  write_frames((folder / "post.tif").string(), (folder / "frames").string(), settings, placement, poses, stop);
  WorldReport report = report_of(before, after, placement, lines);
  report.frames = settings.frames;
  if (report.frames > 0) write_bench_manifest(folder);
  write_report(report, settings, folder);
  return report;
}

}  // namespace roadfix::world
