#include "tiles/world/paint_crowns.hpp"

#include <algorithm>
#include <cmath>

#include "core/units/splitmix.hpp"
#include "tiles/world/palette.hpp"

namespace roadfix::world {
namespace {

constexpr double kAutumnFrom = 0.45;  // of the way from summer to winter
constexpr double kBareFrom = 0.72;

/// Numbers of one tree, in [0, 1), without a generator for each of a million trees.
class Quirks {
 public:
  explicit Quirks(PlanPoint p)
      : bits_(static_cast<std::uint64_t>((p.x + 1e5) * 64.0) * kGoldenGamma ^
              static_cast<std::uint64_t>((p.y + 1e5) * 64.0)) {}
  double next() { return bits_.uniform(); }
  PlanPoint within(double radius) {
    const double angle = next() * 6.2831853;
    return PlanPoint(std::cos(angle), std::sin(angle)) * (radius * std::sqrt(next()));
  }

 private:
  SplitMix64 bits_;
};

class CrownPainter {
 public:
  CrownPainter(Canvas& canvas, const Tree& tree, const Conditions& conditions)
      : canvas_(canvas), tree_(tree), to_sun_(-conditions.shadow_direction()), quirks_(tree.centre) {
    top_ = tree.centre + conditions.lean * (tree.height_m * 0.7);
    season_ = tree.deciduous ? std::clamp(conditions.winter + 0.16 * (quirks_.next() - 0.5), 0.0, 1.0) : 0.0;
  }

  void paint() {
    if (season_ > kBareFrom) {
      branches();
    } else if (tree_.crown == Crown::kConifer) {
      cone(tree_.leaf * tree_.tone);
    } else {
      const double turned = std::clamp((season_ - kAutumnFrom) / (kBareFrom - kAutumnFrom), 0.0, 1.0);
      foliage(palette::mixed(tree_.leaf, tree_.autumn, turned) * tree_.tone);
    }
  }

 private:
  /// Lobes of leaves, the brighter the more they face the sun.
  void foliage(const Colour& colour) {
    const double r = tree_.radius_m;
    const double h = tree_.height_m;
    canvas_.disc(top_, r, colour * 0.66, Material::kLeaves, h * 0.55);
    const int lobes = tree_.crown == Crown::kShrub ? 2 : 4 + static_cast<int>(r);
    for (int i = 0; i < lobes; ++i) {
      const PlanPoint off = quirks_.within(0.62 * r);
      const double light = 0.92 + 0.42 * off.dot(to_sun_) / r + 0.16 * (quirks_.next() - 0.5);
      canvas_.disc(top_ + off, r * (0.3 + 0.22 * quirks_.next()), colour * light, Material::kLeaves,
                   h * (1.0 - 0.35 * cv::norm(off) / r));
    }
    canvas_.disc(top_ + to_sun_ * (0.3 * r), r * 0.36, colour * 1.24, Material::kLeaves, h);
  }

  void cone(const Colour& colour) {
    const double r = tree_.radius_m;
    const double h = tree_.height_m;
    canvas_.disc(top_, r, colour * 0.72, Material::kLeaves, h * 0.4);
    canvas_.disc(top_ + to_sun_ * (0.22 * r), r * 0.68, colour * 1.1, Material::kLeaves, h * 0.68);
    canvas_.disc(top_ + to_sun_ * (0.3 * r), r * 0.34, colour * 1.5, Material::kLeaves, h);
  }

  /// The ground shows between them.
  void branches() {
    const double r = 0.85 * tree_.radius_m;
    const Colour twig = (palette::kBareTree * 1.25 + tree_.autumn * 0.1) * tree_.tone;
    const int count = 3 + static_cast<int>(2.2 * r * r);
    for (int i = 0; i < count; ++i) {
      const PlanPoint off = quirks_.within(r);
      const double light = 0.8 + 0.55 * quirks_.next() + 0.15 * off.dot(to_sun_) / r;
      const double height_m = tree_.height_m * (0.5 + 0.5 * quirks_.next());
      canvas_.disc(top_ + off, 0.3 + 0.35 * quirks_.next(), twig * light, Material::kLeaves, height_m);
    }
  }

  Canvas& canvas_;
  const Tree& tree_;
  PlanPoint to_sun_;
  Quirks quirks_;
  PlanPoint top_;
  double season_ = 0.0;
};

}  // namespace

void paint_crown(Canvas& canvas, const Tree& tree, const Conditions& conditions) {
  CrownPainter(canvas, tree, conditions).paint();
}

}  // namespace roadfix::world
