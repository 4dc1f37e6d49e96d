#include "cli/bench/feature_method.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace roadfix::bench {
namespace {

const UtmZone kZone = UtmZone::containing({37.76, 38.28});

/// Random discs of random brightness: full of keypoints, alike nowhere.
Orthoimage textured(unsigned seed) {
  cv::RNG rng(seed);
  cv::Mat picture(800, 800, CV_8UC3, cv::Scalar::all(120));
  for (int i = 0; i < 1500; ++i) {
    cv::circle(picture, {rng.uniform(0, 800), rng.uniform(0, 800)}, rng.uniform(2, 14),
               cv::Scalar::all(rng.uniform(0, 255)), cv::FILLED);
  }
  return {{picture, cv::Mat(800, 800, CV_8UC1, cv::Scalar(255)), 0.5}, kZone.project({37.76, 38.28})};
}

class FeatureMethods : public ::testing::TestWithParam<FeatureKind> {
 protected:
  const Orthoimage ortho_ = textured(1);
  const std::unique_ptr<Method> method_ = make_feature_method(GetParam(), {ortho_}, kZone);
  const GridPoint place_{ortho_.north_west.east_m + 210.0, ortho_.north_west.north_m - 190.0};
};

TEST_P(FeatureMethods, PlaceAFrameCutFromTheSameImagery) {
  const GridPose truth{place_, Angle::degrees(37)};
  Query query;
  query.view = std::make_shared<GroundView>(vertical_view(cut_out(ortho_, truth, {150, 150}, 0.5)));
  query.truth = GeoPose{kZone.unproject(truth.position), kZone.true_from_grid(truth.heading, truth.position)};
  const Answer answer = method_->answer(query);
  ASSERT_EQ(answer.status, FixStatus::kFix) << answer.reason;
  EXPECT_LT(distance_m(kZone.project(answer.best->position), truth.position), 0.5);
  EXPECT_LT(angular_distance(answer.best->heading, kZone.true_from_grid(truth.heading, truth.position)).degrees(), 0.3);
  ASSERT_TRUE(answer.keypoints);
  EXPECT_GT(answer.keypoints->right, 0.8 * answer.keypoints->matches);
}

TEST_P(FeatureMethods, PlaceTheUavAndNotTheMiddleOfWhatItSees) {
  const GridPose middle{place_, Angle::degrees(90)};
  Query query;
  GroundView view = vertical_view(cut_out(ortho_, middle, {150, 150}, 0.5));
  view.nadir_px.y += 60.0;  // 30 m behind the middle, which is 30 m to the west
  query.view = std::make_shared<GroundView>(view);
  const Answer answer = method_->answer(query);
  ASSERT_EQ(answer.status, FixStatus::kFix) << answer.reason;
  const GridPoint west{middle.position.east_m - 30.0, middle.position.north_m};
  EXPECT_LT(distance_m(kZone.project(answer.best->position), west), 0.5);
}

TEST_P(FeatureMethods, GiveNoFixOnOtherImagery) {
  Query query;
  query.view = std::make_shared<GroundView>(vertical_view(textured(2).image));
  EXPECT_EQ(method_->answer(query).status, FixStatus::kNoFix);
}

INSTANTIATE_TEST_SUITE_P(SiftAndOrb, FeatureMethods, ::testing::Values(FeatureKind::kSift, FeatureKind::kOrb));

}  // namespace
}  // namespace roadfix::bench
