#include "cli/bench/feature_method.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <span>

#include "cli/bench/match_picture.hpp"

namespace roadfix::bench {
namespace {

constexpr int kMinInliers = 15;
constexpr double kLowestScale = 0.8;
constexpr double kHighestScale = 1.25;
constexpr float kLoweRatio = 0.75F;
constexpr double kReprojectionPx = 4.0;
constexpr int kOrbPointsPerMegapixel = 4000;

struct Keypoints {
  std::vector<cv::Point2f>
      points;  ///< of the map: metres east and *south* of the first imagery's corner; of a frame: pixels
  cv::Mat descriptors;
};

cv::Ptr<cv::Feature2D> make_detector(FeatureKind kind, const cv::Size& size) {
  if (kind == FeatureKind::kSift) return cv::SIFT::create();
  const double megapixels = static_cast<double>(size.area()) / 1e6;
  return cv::ORB::create(std::max(500, static_cast<int>(kOrbPointsPerMegapixel * megapixels)));
}

Keypoints detect(FeatureKind kind, const GroundImage& image) {
  cv::Mat grey = image.pixels;
  if (grey.channels() == 3) cv::cvtColor(image.pixels, grey, cv::COLOR_BGR2GRAY);
  std::vector<cv::KeyPoint> found;
  Keypoints result;
  make_detector(kind, grey.size())->detectAndCompute(grey, image.observed, found, result.descriptors);
  cv::KeyPoint::convert(found, result.points);
  return result;
}

cv::Ptr<cv::DescriptorMatcher> make_matcher(FeatureKind kind) {
  if (kind == FeatureKind::kSift) return cv::makePtr<cv::FlannBasedMatcher>();
  return cv::makePtr<cv::BFMatcher>(cv::NORM_HAMMING);
}

class FeatureMethod : public Method {
 public:
  FeatureMethod(FeatureKind kind, const std::vector<Orthoimage>& imagery, const UtmZone& zone)
      : kind_(kind), zone_(zone), origin_(imagery.front().north_west), matcher_(make_matcher(kind)) {
    const std::span all(imagery);
    for (std::size_t i = 0; i < all.size(); ++i) add(all[i], all.first(i));
    if (map_.descriptors.rows < 2) return;
    matcher_->add(std::vector<cv::Mat>{map_.descriptors});
    cv::setRNGSeed(1);  // the index splits at random
    matcher_->train();  // the index over the map is built once
  }

  Answer answer(const Query& query) const override {
    Answer result;
    if (!query.view) {
      result.reason = "no-picture";
      return result;
    }
    const auto start = std::chrono::steady_clock::now();
    const PointMatches matches = matches_of(*query.view);
    place(*query.view, matches, result);
    result.time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (query.truth) {
      const auto right = right_matches(matches, origin_, *query.view, on_grid(*query.truth, zone_), kRightMatchM);
      result.keypoints = {static_cast<int>(right.size()), static_cast<int>(std::ranges::count(right, true))};
    }
    return result;
  }

  cv::Mat drawn(const Query& query, const Answer&, std::span<const Orthoimage> imagery) const override {
    if (!query.view) return {};
    std::optional<GridPose> truth;
    if (query.truth) truth = on_grid(*query.truth, zone_);
    return match_picture(imagery, *query.view, matches_of(*query.view), truth);
  }

 private:
  /// Where images overlap the first one counts, as in a map: a point known twice would fail the ratio test.
  void add(const Orthoimage& ortho, std::span<const Orthoimage> before) {
    const Keypoints found = detect(kind_, ortho.image);
    for (int i = 0; i < found.descriptors.rows; ++i) {
      const cv::Point2d point = found.points[static_cast<std::size_t>(i)];
      const GridPoint place{ortho.north_west.east_m + (point.x + 0.5) * ortho.image.gsd_m,
                            ortho.north_west.north_m - (point.y + 0.5) * ortho.image.gsd_m};
      if (std::ranges::any_of(before, [&](const Orthoimage& other) { return sees(other, place); })) continue;
      map_.points.emplace_back(static_cast<float>(place.east_m - origin_.east_m),
                               static_cast<float>(origin_.north_m - place.north_m));
      map_.descriptors.push_back(found.descriptors.row(i));
    }
  }

  PointMatches matches_of(const GroundView& view) const {
    const Keypoints frame = detect(kind_, view.image);
    PointMatches matches;
    for (const cv::DMatch& match : good_matches(frame)) {
      matches.frame_px.push_back(frame.points[static_cast<std::size_t>(match.queryIdx)]);
      matches.map_m.push_back(map_.points[static_cast<std::size_t>(match.trainIdx)]);
    }
    return matches;
  }

  std::vector<cv::DMatch> good_matches(const Keypoints& frame) const {
    if (frame.descriptors.rows < 2 || map_.descriptors.rows < 2) return {};
    std::vector<std::vector<cv::DMatch>> pairs;
    {
      const std::lock_guard lock(matching_);
      matcher_->knnMatch(frame.descriptors, pairs, 2);
    }
    std::vector<cv::DMatch> good;
    for (const auto& pair : pairs) {
      if (pair.size() == 2 && pair[0].distance < kLoweRatio * pair[1].distance) good.push_back(pair[0]);
    }
    return good;
  }

  void place(const GroundView& view, const PointMatches& matches, Answer& result) const {
    const auto& [from, to] = matches;
    result.reason = "too-few-matches";
    if (from.size() < 3) return;
    cv::Mat inliers;
    const cv::Mat similarity =
        cv::estimateAffinePartial2D(from, to, inliers, cv::RANSAC, kReprojectionPx * view.image.gsd_m, 5000);
    if (similarity.empty()) return;
    const cv::Matx23d map_from_frame = similarity;
    const double scale = std::hypot(map_from_frame(0, 0), map_from_frame(1, 0)) / view.image.gsd_m;
    if (scale < kLowestScale || scale > kHighestScale) {
      result.reason = "wrong-scale";
      return;
    }
    result.best = pose_of(map_from_frame, view);
    const int count = cv::countNonZero(inliers);
    result.probability = static_cast<double>(count) / static_cast<double>(from.size());
    if (count < kMinInliers) return;
    result.status = FixStatus::kFix;
    result.reason.clear();
  }

  /// The plane of the keypoints has rows running south, so its rotation is the compass heading.
  GeoPose pose_of(const cv::Matx23d& map_from_frame, const GroundView& view) const {
    const cv::Vec2d nadir = map_from_frame * cv::Vec3d(view.nadir_px.x - 0.5, view.nadir_px.y - 0.5, 1.0);
    const GridPoint position{origin_.east_m + nadir[0], origin_.north_m - nadir[1]};
    const Angle grid_heading = Angle::radians(std::atan2(map_from_frame(1, 0), map_from_frame(0, 0)));
    return {zone_.unproject(position), zone_.true_from_grid(grid_heading, position)};
  }

  FeatureKind kind_;
  UtmZone zone_;
  GridPoint origin_;
  Keypoints map_;
  cv::Ptr<cv::DescriptorMatcher> matcher_;
  mutable std::mutex matching_;  // OpenCV promises nothing about concurrent matching
};

}  // namespace

std::unique_ptr<Method> make_feature_method(FeatureKind kind, const std::vector<Orthoimage>& imagery,
                                            const UtmZone& zone) {
  return std::make_unique<FeatureMethod>(kind, imagery, zone);
}

}  // namespace roadfix::bench
