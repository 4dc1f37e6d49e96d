#include "tiles/world/paint_tracks.hpp"

#include <algorithm>

#include "tiles/world/palette.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {
namespace {

constexpr double kWheelM = 0.85;  // from a track's middle to each wheel mark
constexpr double kMarkedM = 5.6;  // roads at least this wide may have a middle line

class TrackPainter {
 public:
  TrackPainter(Canvas& canvas, const Street& street, std::size_t number, const Plan& plan, const Conditions& conditions)
      : canvas_(canvas),
        street_(street),
        conditions_(conditions),
        random_(number, 37),
        grass_(palette::varied(plan.country.grass, 0.1, random_)),
        soil_(plan.country.soil) {
    const Colour straw(142, 126, 92);
    grass_ = palette::mixed(grass_, straw, 0.5 * conditions.winter);
  }

  void paint_verge() {
    const double beyond = random_.uniform(0.6, 2.4);
    const Colour verge = grass_ * 0.85 + soil_ * 0.15;
    canvas_.stroke(street_.line, street_.width_m + beyond, verge, Material::kGrass);
  }

  void paint() {
    random_.unit();
    const Colour surface = colour();
    if (street_.surface == Surface::kAsphalt) {
      pave(surface);
      return;
    }
    const double wear = street_.wear;
    const Colour worn = surface * wear + grass_ * (1.0 - wear);
    if (street_.grass_strip) {
      uneven(0.0, street_.width_m, worn * 0.45 + grass_ * 0.55, 0.12);
      wheel_marks(worn, 0.95);
    } else {
      uneven(0.0, street_.width_m, worn, 0.14);
      wheel_marks(worn * random_.uniform(0.93, 1.1), 0.8);
    }
  }

 private:
  Colour colour() {
    const double dust = conditions_.dust;
    switch (street_.surface) {
      case Surface::kAsphalt:
      case Surface::kKerbed: {
        const Colour tar = palette::varied(palette::kAsphalt, 0.22, random_) * conditions_.asphalt;
        return palette::mixed(tar, palette::kDust, 0.6 * dust);
      }
      case Surface::kGravel:
        return palette::varied(random_.chance(0.5) ? Colour(184, 174, 158) : Colour(160, 156, 150), 0.14, random_);
      case Surface::kSand:
        return palette::varied({206, 188, 154}, 0.1, random_);
      case Surface::kEarth:
        break;
    }
    return palette::varied(soil_ * 1.12, 0.14, random_);
  }

  void pave(const Colour& surface) {
    canvas_.stroke(street_.line, street_.width_m, surface, Material::kAsphalt);
    const Colour rim = surface * 0.7 + soil_ * 0.32;
    for (const double side : {-1.0, 1.0}) {  // soil creeps over the edge
      uneven(side * street_.width_m / 2.0, 0.5, rim, 0.6);
    }
    if (random_.chance(0.5)) canvas_.stroke(street_.line, street_.width_m * 0.6, surface * 0.95, Material::kAsphalt);
    if (street_.width_m >= kMarkedM && random_.chance(0.6)) {
      const Colour marking = palette::mixed(palette::kMarking, palette::kDust, conditions_.dust);
      walk(street_.line, 2.0, 9.0, [&](PlanPoint p, PlanPoint along) {
        canvas_.stroke({p, p + along * 4.0}, 0.25, marking, Material::kAsphalt);
      });
    }
  }

  void wheel_marks(const Colour& colour, double width) {
    for (const double side : {-1.0, 1.0}) uneven(side * std::min(kWheelM, street_.width_m * 0.3), width, colour, 0.25);
  }

  /// A band beside the middle line whose width and brightness vary along it.
  void uneven(double off, double width, const Colour& colour, double variation) {
    double drift = 0.0;
    for (std::size_t i = 0; i + 1 < street_.line.size(); ++i) {
      drift = 0.7 * drift + 0.7 * random_.uniform(-1.0, 1.0);
      const double tone = 1.0 + 0.07 * std::clamp(drift, -1.5, 1.5);
      const double wide = width * (1.0 + variation * std::clamp(drift + random_.uniform(-0.5, 0.5), -1.0, 1.0));
      const PlanPoint from = beside(street_.line, i, off);
      const PlanPoint to = beside(street_.line, i + 1, off);
      if (canvas_.sees((from + to) / 2.0, 10.0 + width)) {
        canvas_.stroke({from, to}, wide, colour * tone, Material::kBare);
      }
    }
  }

  Canvas& canvas_;
  const Street& street_;
  const Conditions& conditions_;
  Random random_;
  Colour grass_;
  Colour soil_;
};

}  // namespace

void paint_tracks(Canvas& canvas, const Plan& plan, const Conditions& conditions) {
  const auto each = [&](bool verge) {
    for (std::size_t i = 0; i < plan.streets.size(); ++i) {
      const Street& street = plan.streets[i];
      if (street.surface == Surface::kKerbed) continue;
      TrackPainter painter(canvas, street, i, plan, conditions);
      verge ? painter.paint_verge() : painter.paint();
    }
  };
  each(true);
  each(false);
}

}  // namespace roadfix::world
