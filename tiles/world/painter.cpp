#include "tiles/world/painter.hpp"

#include <cmath>

#include "tiles/world/canvas.hpp"
#include "tiles/world/light.hpp"
#include "tiles/world/paint_buildings.hpp"
#include "tiles/world/paint_damage.hpp"
#include "tiles/world/paint_ground.hpp"
#include "tiles/world/paint_railway.hpp"
#include "tiles/world/paint_streets.hpp"
#include "tiles/world/paint_tracks.hpp"

namespace roadfix::world {
namespace {

constexpr double kTallestM = 28.0;
constexpr int kCornerStep = 8;  // of the tile grid on which haze is computed

int margin_px(const Conditions& conditions, double gsd_m) {
  const double reach = kTallestM * (conditions.shadow_length() + cv::norm(conditions.lean)) + 10.0;
  return (static_cast<int>(std::ceil(reach / gsd_m)) / kCornerStep + 1) * kCornerStep;
}

}  // namespace

cv::Mat3b paint_tile(const Plan& plan, const Conditions& conditions, const Texture& texture, cv::Rect tile,
                     double gsd_m) {
  const int margin = margin_px(conditions, gsd_m);
  const cv::Rect pixels(tile.x - margin, tile.y - margin, tile.width + 2 * margin, tile.height + 2 * margin);
  Canvas canvas(pixels, gsd_m);
  paint_ground(canvas, plan, conditions);
  paint_streets(canvas, plan, conditions);
  paint_railway(canvas, plan.country, conditions);
  paint_tracks(canvas, plan, conditions);
  paint_boxes(canvas, plan);
  paint_slides(canvas, plan.country);
  paint_debris(canvas, plan);
  paint_buildings(canvas, plan, conditions);
  paint_trees(canvas, plan, conditions);
  paint_logs(canvas, plan.country, conditions);
  texture.apply(canvas.colour(), canvas.material(), pixels, gsd_m);
  shade(canvas.colour(), cast_shadows(canvas.height(), gsd_m, conditions));
  expose(canvas.colour(), pixels, gsd_m, conditions, plan.debris, texture);
  return canvas.colour()(cv::Rect(margin, margin, tile.width, tile.height)).clone();
}

}  // namespace roadfix::world
