#include "server/api/flight_request.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "core/detect/feature_map_codec.hpp"
#include "core/locate/told_frames.hpp"
#include "server/api/base64.hpp"
#include "tests/server/api/request_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/drone_jpeg.hpp"
#include "tests/support/random_cells.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

CellArray seen(int cols, int rows) {
  std::mt19937_64 random(31);
  return testing::smooth_cells(random, cols, rows);
}

json another(const std::vector<std::uint8_t>& picture, const BodyOffset& offset) {
  return {{"image", base64_encoded(picture)},
          {"forward_m", offset.forward_m},
          {"right_m", offset.right_m},
          {"turn_deg", offset.turn.degrees()}};
}

Content content_of(std::vector<std::uint8_t> picture, const json& request) {
  Content content{fields_of(request, joined({feature_fields(), flight_members()}))};
  give_picture(content, std::move(picture));
  return content;
}

Features read(const Content& content, const Limits& limits = {}) {
  return flight_features_of(content, {NoRoads(), 2.0}, limits);
}

/// Features of a request in cells of 2 m, beside whose picture there is `also`.
Features read_with(const json& also, const Limits& limits = {}) {
  return read(content_of(encode_feature_map(seen(20, 16)), {{"cell_m", 2}, {"also", also}}), limits);
}

const BodyOffset kBehind{-30.0, 4.0, Angle::degrees(15.0)};

TEST(FlightRequest, IsItsPictureAloneWhereItTellsOfNoOthers) {
  const Features features = read(content_of(encode_feature_map(seen(20, 16)), {{"cell_m", 2}}));
  EXPECT_EQ(features.map, FeatureMap::centred(seen(20, 16), 2.0));
  EXPECT_FALSE(features.own_frame);
}

TEST(FlightRequest, LaysOthersAroundItsPictureWhereTheyWereTaken) {
  const BodyOffset ahead{25.0, 0.0, Angle::degrees(-20.0)};
  const Features features =
      read_with({another(encode_feature_map(seen(18, 18)), kBehind), another(encode_feature_map(seen(10, 30)), ahead)});
  const FeatureMap own = FeatureMap::centred(seen(20, 16), 2.0);
  const std::vector<PlacedFeatures> parts{
      {own, {}}, {FeatureMap::centred(seen(18, 18), 2.0), kBehind}, {FeatureMap::centred(seen(10, 30), 2.0), ahead}};
  EXPECT_EQ(features.map, laid_together(parts, 1e6).features);
  EXPECT_EQ(features.own_frame, own) << "which has to bear out the answer by itself";
}

TEST(FlightRequest, ReadsTheCameraOfEachFrameFromItsFile) {
  const auto photo = [](const char* height_m) {
    return testing::drone_jpeg(cv::Mat(40, 60, CV_8UC1, cv::Scalar(128)),
                               fmt::format("drone-dji:RelativeAltitude=\"{}\" drone-dji:GimbalPitchDegree=\"-60\" "
                                           "drone-dji:GimbalYawDegree=\"0\" drone-dji:GimbalRollDegree=\"0\" "
                                           "drone-dji:CalibratedFocalLength=\"60\"",
                                           height_m));
  };
  const json frame{{"kind", "frame"}, {"exif", true}};
  json request = frame;
  request["also"] = json::array({another(photo("+80.00"), kBehind)});
  const Features features = read(content_of(photo("+40.00"), request));
  const auto alone = [&](const char* height_m) { return read(content_of(photo(height_m), frame)).map; };
  const std::vector<PlacedFeatures> parts{{alone("+40.00"), {}}, {alone("+80.00"), kBehind}};
  ASSERT_GT(std::abs(parts[0].features.nadir.row - parts[1].features.nadir.row), 5.0);
  EXPECT_EQ(features.map, laid_together(parts, 1e6).features);
  EXPECT_EQ(features.camera_in_file.value().agl_m, 40.0) << "of the picture that is asked for";
  EXPECT_EQ(features.others.at(0).higher_m, 40.0);
  EXPECT_TRUE(features.detect_time);
}

TEST(FlightRequest, SaysWhichOfTheOthersIsWrong) {
  const json good = another(encode_feature_map(seen(18, 18)), kBehind);
  const auto complaint = [&](const char* name, const json& value) {
    json bent = good;
    bent[name] = value;
    return refused([&] { read_with({good, bent}); });
  };
  EXPECT_EQ(complaint("turn_deg", "left"), "bad-parameter also[1].turn_deg");
  EXPECT_EQ(complaint("turn_deg", 361), "parameter-out-of-range also[1].turn_deg");
  EXPECT_EQ(complaint("forward_m", 100'001), "parameter-out-of-range also[1].forward_m");
  EXPECT_EQ(complaint("image", "!"), "bad-base64 also[1].image");
  EXPECT_EQ(complaint("image", ""), "missing-parameter also[1].image");
  EXPECT_EQ(complaint("image", 7), "missing-parameter also[1].image");
  EXPECT_EQ(complaint("cell_m", 2), "bad-parameter also[1]") << "all have that of the request";
  json renamed = good;
  renamed.erase("right_m");
  EXPECT_EQ(refused([&] { read_with(json::array({renamed})); }), "bad-parameter also[0]");
  renamed["left_m"] = -4;
  EXPECT_EQ(refused([&] { read_with(json::array({renamed})); }), "missing-parameter also[0].right_m");
  EXPECT_EQ(refused([&] { read_with({good, 7}); }), "bad-parameter also[1]");
}

TEST(FlightRequest, SaysWhosePictureCannotBeRead) {
  const json good = another(encode_feature_map(seen(18, 18)), kBehind);
  const auto action = [&] { read_with({good, another({'n', 'o', 'n', 'e'}, kBehind)}); };
  EXPECT_EQ(testing::code_of(action), "image-format");
  EXPECT_THAT(testing::message_of(action), ::testing::StartsWith("also[1].image: "));
}

TEST(FlightRequest, NamesAFieldThatAllShareByItself) {
  // The request's own picture tells its cell size, the other does not.
  const auto own = encode_feature_map(FeatureMap::centred(seen(20, 16), 2.0));
  const json also = json::array({another(encode_feature_map(seen(18, 18)), kBehind)});
  EXPECT_EQ(refused([&] { read(content_of(own, {{"also", also}})); }), "missing-parameter cell_m");
}

TEST(FlightRequest, RefusesOthersInCellsOfAnotherSize) {
  const auto of_cells = [](int rows, double cell_m) {
    return encode_feature_map(FeatureMap::centred(seen(18, rows), cell_m));
  };
  const auto code = [&](double cell_m) {
    const json also = json::array({another(of_cells(16, cell_m), kBehind)});
    return testing::code_of([&] { read(content_of(of_cells(18, 1.5), {{"also", also}})); });
  };
  EXPECT_EQ(code(1.5), "no error");
  EXPECT_EQ(code(2.0), "cell-size-contradictory");
}

TEST(FlightRequest, NeedsAListOfOthersInJson) {
  EXPECT_EQ(refused([] { read_with(7); }), "bad-parameter also");
  Content query = content_of(encode_feature_map(seen(20, 16)), {{"cell_m", 2}});
  query.fields.add_text("also", "[]");
  EXPECT_EQ(refused([&] { read(query); }), "bad-parameter also");
  EXPECT_EQ(read_with(json::array()).map, FeatureMap::centred(seen(20, 16), 2.0));
}

TEST(FlightRequest, RefusesCellsBesideOthers) {
  const Content content{fields_of({{"cell_m", 2}, {"cols", 2}, {"rows", 1}, {"cells", "AP4="}, {"also", json::array()}},
                                  joined({feature_fields(), flight_members()})),
                        {},
                        true};
  EXPECT_EQ(refused([&] { read(content); }), "bad-parameter cells");
}

TEST(FlightRequest, LaysAsManyFramesTogetherAsTheLimitsAllow) {
  const json frame = another(encode_feature_map(seen(18, 18)), kBehind);
  Limits limits;
  limits.frames = 3;
  EXPECT_EQ(testing::code_of([&] { read_with({frame, frame}, limits); }), "no error");
  EXPECT_EQ(testing::code_of([&] { read_with({frame, frame, frame}, limits); }), "too-many-frames");
  const json far = another(encode_feature_map(seen(18, 18)), {9e4, 9e4, {}});
  EXPECT_EQ(testing::code_of([&] { read_with(json::array({far}), limits); }), "frames-too-far-apart");
}

}  // namespace
}  // namespace roadfix::api
