#include "tiles/world/country_survey.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "tiles/world/distortion.hpp"
#include "tiles/world/palette.hpp"
#include "tiles/world/polygon.hpp"
#include "tiles/world/tracks.hpp"

namespace roadfix::world {
namespace {

constexpr std::array<double, 6> kFieldWavesM{900.0, 520.0, 310.0, 190.0, 120.0, 75.0};
constexpr double kBendStepM = 6.0;
constexpr double kMarginM = 120.0;
constexpr double kEstateM2 = 250'000.0;  // boundaries of more than this are likely to carry a road

/// Colours and habits of a region.
struct Region {
  Colour soil;
  Colour grass;
  double scrub;  ///< share of open parcels
  double farmed;
};

Region any_region(Random& random) {
  static const std::array<Region, 6> kRegions{{{{132, 108, 84}, {86, 114, 60}, 0.05, 0.55},
                                               {{146, 122, 94}, {108, 120, 72}, 0.1, 0.6},
                                               {{150, 128, 102}, {126, 128, 86}, 0.15, 0.6},
                                               {{176, 148, 114}, {150, 138, 102}, 0.45, 0.45},
                                               {{160, 114, 86}, {128, 120, 82}, 0.3, 0.5},
                                               {{118, 100, 82}, {78, 100, 62}, 0.05, 0.4}}};
  Region region = kRegions[random.index(kRegions.size())];
  region.soil = palette::varied(region.soil, 0.12, random);
  region.grass = palette::varied(region.grass, 0.12, random);
  return region;
}

/// Where woods are: smooth, so that neighbouring parcels share them.
class Woods {
 public:
  explicit Woods(Random& random)
      : phase_{random.uniform(0.0, 6.3), random.uniform(0.0, 6.3)}, threshold_(random.uniform(-0.65, 0.7)) {}
  bool operator()(PlanPoint p) const {
    return 0.6 * std::sin(p.x / 85.0 + 1.1 * std::sin(p.y / 120.0) + phase_.x) + 0.6 * std::sin(p.y / 95.0 + phase_.y) >
           threshold_;
  }

 private:
  PlanPoint phase_;
  double threshold_;
};

class Surveyor {
 public:
  Surveyor(Plan& plan, Random& random)
      : plan_(plan),
        country_(plan.country),
        random_(random),
        bend_(random, kFieldWavesM, random.uniform(0.012, 0.036)),
        wooded_(random),
        region_(any_region(random)),
        plot_m2_(random.uniform(7'000.0, 32'000.0)),
        tracks_(random.uniform(0.12, 0.34)) {}

  void survey() {
    country_.soil = region_.soil;
    country_.grass = region_.grass;
    const double side = std::hypot(plan_.width_m, plan_.height_m) + 2.0 * kMarginM;
    const Footprint all{{plan_.width_m / 2.0, plan_.height_m / 2.0}, random_.uniform(0.0, 1.57), side, side};
    split(all.corners());
  }

 private:
  bool outside(const Polyline& polygon) const {
    const cv::Rect2d seen(-kMarginM, -kMarginM, plan_.width_m + 2.0 * kMarginM, plan_.height_m + 2.0 * kMarginM);
    return (box_of(polygon) & seen).empty();
  }

  void split(const Polyline& polygon) {
    if (polygon.size() < 3 || outside(polygon)) return;
    const double area = area_of(polygon);
    if (area < plot_m2_ * random_.uniform(0.6, 1.9)) {
      add_parcel(polygon);
      return;
    }
    PlanPoint along = longest_side(polygon);
    const PlanPoint across = perpendicular(along);
    if (extent_along(polygon, across) > extent_along(polygon, along)) along = across;
    const double skew = random_.normal() * 0.16;
    const PlanPoint normal = perpendicular(along);
    const double shift = extent_along(polygon, along) * random_.uniform(-0.22, 0.22);
    const Cut halves =
        cut(polygon, middle_of(polygon) + along * shift, normal * std::cos(skew) + along * std::sin(skew));
    if (halves.chord.size() != 2) return;
    add_boundary(halves.chord, area);
    for (const Polyline& part : halves.parts) split(part);
  }

  void add_boundary(const Polyline& chord, double area) {
    const PlanPoint middle = (chord[0] + chord[1]) / 2.0;
    const double draw = random_.unit();
    if (area > kEstateM2 && draw < (area > 2.0 * kEstateM2 ? 0.6 : 0.25)) {
      pave(bend_.bent(chord[0], chord[1], kBendStepM));
    } else if (random_.chance(area > kEstateM2 ? 0.6 : tracks_)) {
      add_track(chord);
    } else if (wooded_(bend_(middle))) {
      add_ride(bend_.bent(chord[0], chord[1], kBendStepM));
    } else {
      add_edge(bend_.bent(chord[0], chord[1], kBendStepM));
    }
  }

  void pave(Polyline line) {
    const bool large = random_.chance(0.45);
    const double width = large ? random_.uniform(5.6, 7.2) : random_.uniform(4.4, 5.8);
    plan_.streets.push_back({.road_class = large ? "tertiary" : "unclassified",
                             .width_m = std::round(width * 10.0) / 10.0,
                             .line = std::move(line),
                             .surface = Surface::kAsphalt});
  }

  /// Some end blind.
  void add_track(Polyline chord) {
    if (random_.chance(0.25)) {
      const std::size_t blind = random_.index(2);
      chord[blind] = chord[1 - blind] + (chord[blind] - chord[1 - blind]) * random_.uniform(0.4, 0.85);
    }
    Street track = unpaved(random_);
    track.line = bend_.bent(chord[0], chord[1], kBendStepM);
    plan_.streets.push_back(std::move(track));
  }

  /// In a wood: a fire break, a footpath, or nothing.
  void add_ride(Polyline line) {
    const double draw = random_.unit();
    const Colour cover = palette::varied(country_.grass, 0.12, random_) * 0.9;
    if (draw < 0.14) {
      country_.strips.push_back({std::move(line), random_.uniform(3.5, 8.0), cover, true});
    } else if (draw > 0.86) {
      country_.strips.push_back({std::move(line), random_.uniform(0.7, 1.2), country_.soil, false});
    }
  }

  /// Between fields: a hedge, a ditch, a footpath or a margin of grass.
  void add_edge(Polyline line) {
    const double draw = random_.unit();
    if (draw < 0.38) {
      country_.strips.push_back({line, random_.uniform(1.5, 3.0), country_.grass * 0.82, false});
      country_.hedges.push_back(std::move(line));
    } else if (draw < 0.48) {
      country_.strips.push_back({std::move(line), random_.uniform(0.8, 2.0), country_.grass * 0.6, true});
    } else if (draw < 0.55) {
      country_.strips.push_back({std::move(line), random_.uniform(0.6, 1.1), country_.soil * 1.08, true});
    } else if (draw < 0.85) {
      const Colour margin = palette::varied(country_.grass, 0.15, random_);
      country_.strips.push_back({std::move(line), random_.uniform(0.8, 3.2), margin, true});
    }
  }

  Cover any_cover(PlanPoint at) {
    if (wooded_(at)) return Cover::kWood;
    const double draw = random_.unit();
    if (draw < region_.scrub) return Cover::kScrub;
    if (draw < region_.scrub + (1.0 - region_.scrub) * (1.0 - region_.farmed)) return Cover::kMeadow;
    static const std::array<Cover, 5> kFarmed{Cover::kCrop, Cover::kCrop, Cover::kPlough, Cover::kStubble,
                                              Cover::kOrchard};
    return kFarmed[random_.index(random_.chance(0.3) ? 5 : 4)];
  }

  void add_parcel(const Polyline& polygon) {
    Parcel parcel;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Polyline side = bend_.bent(polygon[i], polygon[(i + 1) % polygon.size()], kBendStepM);
      parcel.outline.insert(parcel.outline.end(), side.begin(), side.end() - 1);
    }
    const PlanPoint middle = middle_of(parcel.outline);
    parcel.cover = any_cover(middle);
    paint(parcel);
    const PlanPoint along = longest_side(polygon);
    parcel.row_angle_rad = std::atan2(along.y, along.x) + (random_.chance(0.25) ? std::numbers::pi / 2.0 : 0.0);
    parcel.seed = random_.bits();
    country_.parcels.push_back(std::move(parcel));
  }

  void paint(Parcel& parcel) {
    const Colour straw(142, 126, 92);
    const auto green = [&](const Colour& c, double fading) {
      parcel.summer = palette::varied(c, 0.14, random_);
      parcel.winter = palette::mixed(parcel.summer, straw, fading);
    };
    const auto bare = [&](const Colour& c) { parcel.summer = parcel.winter = palette::varied(c, 0.14, random_); };
    switch (parcel.cover) {
      case Cover::kWood:
        parcel.summer = country_.grass * 0.5 + Colour(16, 14, 10);
        parcel.winter = palette::varied({112, 94, 74}, 0.1, random_);
        break;
      case Cover::kMeadow:
        return green(country_.grass, 0.6);
      case Cover::kScrub:
        return bare(country_.soil * 0.75 + country_.grass * 0.25);
      case Cover::kCrop:
        return green(random_.chance(0.7) ? country_.grass * 0.85 : Colour(150, 140, 84), 0.45);
      case Cover::kPlough:
        return bare(country_.soil * random_.uniform(0.75, 1.0));
      case Cover::kStubble:
        return bare(Colour(186, 168, 128) * random_.uniform(0.85, 1.05));
      case Cover::kOrchard:
        return random_.chance(0.5) ? green(country_.grass, 0.5) : bare(country_.soil);
    }
  }

  Plan& plan_;
  Countryside& country_;
  Random& random_;
  Distortion bend_;
  Woods wooded_;
  Region region_;
  double plot_m2_;
  double tracks_;
};

}  // namespace

void survey_country(Plan& plan, Random& random) { Surveyor(plan, random).survey(); }

}  // namespace roadfix::world
