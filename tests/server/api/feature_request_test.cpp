#include "server/api/feature_request.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <vector>

#include "core/detect/feature_map_codec.hpp"
#include "core/detect/frame_camera.hpp"
#include "core/units/error.hpp"
#include "tests/server/api/request_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/drone_jpeg.hpp"
#include "tests/support/encoded.hpp"

namespace roadfix::api {
namespace {

FeatureMap map_of(const nlohmann::json& request) {
  Content content;
  content.fields.add(request, feature_fields());
  give_picture(content, encode_feature_map(CellArray(20, 20, kNoRoad)));
  return features_of(content, {NoRoads(), 2.0}, Limits{}).map;
}

double nadir_sigma_m_of(const nlohmann::json& request) { return map_of(request).nadir_sigma_m; }
double nadir_heading_sigma_deg_of(const nlohmann::json& request) {
  return map_of(request).nadir_heading_sigma.degrees();
}

TEST(FeatureRequest, ExpectsAnErrorOfADegreeOfAnAttitudeThatIsToldAndOfTheHeightWhereTheCameraLeans) {
  const double degree_m = 40 * std::numbers::pi / 180.0;
  nlohmann::json request{{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}, {"roll_deg", 0}, {"pitch_deg", 0}};
  EXPECT_NEAR(nadir_sigma_m_of(request), degree_m, 1e-9);
  request["pitch_deg"] = 45;
  EXPECT_NEAR(nadir_sigma_m_of(request), std::hypot(2 * degree_m, 40 * kHeightSigma), 1e-9);
}

TEST(FeatureRequest, ExpectsThatACameraMayLeanAsFarAsItSaysNothingOfIt) {
  const double untold_m = 40 * kUntoldAttitudeSigma.radians();
  EXPECT_NEAR(nadir_sigma_m_of({{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}}), untold_m, 1e-9);
  for (const char* alone : {"roll_deg", "pitch_deg"}) {
    EXPECT_NEAR(nadir_sigma_m_of({{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}, {alone, 0}}), untold_m, 1e-9)
        << alone;
  }
}

TEST(FeatureRequest, ExpectsThatWhatALeaningCameraSeesIsTurned) {
  nlohmann::json request{{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}, {"roll_deg", 0}, {"pitch_deg", 0}};
  const double level_deg = nadir_heading_sigma_deg_of(request);
  EXPECT_GT(level_deg, 0.0) << "of an error of the height";
  request["pitch_deg"] = 40;
  EXPECT_GT(nadir_heading_sigma_deg_of(request), 1.5 * level_deg);
}

TEST(FeatureRequest, TakesPlaceAndHeadingOfTheNadirInOtherPicturesForExact) {
  for (const nlohmann::json& exact : {nlohmann::json{{"cell_m", 2}}, {{"kind", "frame"}, {"gsd_m", 0.5}}}) {
    EXPECT_EQ(nadir_sigma_m_of(exact), 0.0);
    EXPECT_EQ(nadir_heading_sigma_deg_of(exact), 0.0);
  }
}

TEST(FeatureRequest, SaysOfAPictureWithoutAWordHowAFrameIsSent) {
  Content content;
  give_picture(content, testing::encoded(".png", cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(90))));
  EXPECT_THAT(testing::message_of([&] {
                features_of(content, {NoRoads(), 2.0}, Limits{});
              }),
              ::testing::HasSubstr("add kind=frame, and gsd_m"));
}

/// Keeps what share of the picture it is told was observed.
class Watching : public NoRoads {
 public:
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t seed,
                   const std::stop_token& stop) const override {
    observed_share = cv::countNonZero(image.observed) / static_cast<double>(image.observed.total());
    return NoRoads::detect(image, cell_m, seed, stop);
  }
  mutable double observed_share = 0.0;
};

TEST(FeatureRequest, TakesABlackBorderForGroundThatWasNotSeenWhereItIsToldSo) {
  cv::Mat frame(40, 40, CV_8UC3);
  cv::RNG random(1);
  random.fill(frame, cv::RNG::UNIFORM, 40, 200);
  random.fill(frame.colRange(0, 20), cv::RNG::UNIFORM, 1, 5);  // ground in the dark, unless it is said to be none
  const auto observed_share = [&](const nlohmann::json& told) {
    Content content;
    content.fields.add({{"kind", "frame"}, {"gsd_m", 1}}, feature_fields());
    content.fields.add(told, feature_fields());
    give_picture(content, testing::encoded(".png", frame));
    const Watching detector;
    features_of(content, {detector, 2.0}, Limits{});
    return detector.observed_share;
  };
  EXPECT_EQ(observed_share(nlohmann::json::object()), 1.0);
  EXPECT_EQ(observed_share({{"unobserved", "seen"}}), 1.0);
  EXPECT_NEAR(observed_share({{"unobserved", "black"}}), 0.5, 0.05);
}

TEST(FeatureRequest, TakesWhatItIsToldOfTheNadir) {
  EXPECT_EQ(nadir_sigma_m_of({{"cell_m", 2}, {"nadir_sigma_m", 12}}), 12.0);
  EXPECT_EQ(nadir_sigma_m_of({{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}, {"nadir_sigma_m", 0}}), 0.0);
  EXPECT_DOUBLE_EQ(nadir_heading_sigma_deg_of({{"cell_m", 2}, {"nadir_heading_sigma_deg", 1.5}}), 1.5);
  EXPECT_EQ(
      nadir_heading_sigma_deg_of({{"kind", "frame"}, {"fov_deg", 60}, {"agl_m", 40}, {"nadir_heading_sigma_deg", 0}}),
      0.0);
}

TEST(FeatureRequest, TakesCellSizeAndNadirFromAFeatureMapThatTellsThem) {
  const FeatureMap map{CellArray(20, 10, kNoRoad), 1.5, {10.0, 33.5}, 4.0};
  const auto read = [&](const nlohmann::json& request) {
    Content content;
    content.fields.add(request, feature_fields());
    give_picture(content, encode_feature_map(map));
    return features_of(content, {NoRoads(), 2.0}, Limits{}).map;
  };
  EXPECT_EQ(read(nlohmann::json::object()), map);
  EXPECT_EQ(read({{"cell_m", 1.5}}), map);
  EXPECT_EQ(read({{"nadir_col", 10}, {"nadir_row", 33.5}}), map);
  EXPECT_EQ(testing::code_of([&] { read({{"nadir_row", 5}}); }), "nadir-contradictory");
  EXPECT_EQ(testing::code_of([&] { read({{"cell_m", 2}}); }), "cell-size-contradictory");
  EXPECT_EQ(testing::code_of([&] { read({{"kind", "frame"}, {"gsd_m", 2}}); }), "frame-is-feature-map");
}

std::string part(const std::string& name, const std::string& value) {
  return "--b\r\nContent-Disposition: form-data; name=\"" + name + "\"\r\n\r\n" + value + "\r\n";
}

/// Its picture only in base64, since the body ends here.
Content content_of(const std::string& type, const std::string& body) {
  http::Request request;
  request.headers["content-type"] = type;
  request.body = body;
  return read_content(request, joined({feature_fields(), picture_members()}), Limits{});
}
Content json_content(const nlohmann::json& body) { return content_of("application/json", body.dump()); }
Content form_content(const std::string& parts) {
  return content_of("multipart/form-data; boundary=b", parts + "--b--\r\n");
}

TEST(FeatureRequest, RefusesASecondPictureWhicheverComesFirst) {
  const std::string picture = part("image", "one");
  const std::string request = part("request", R"({"image": "dHdv"})");
  for (const std::string& parts :
       {picture + request, request + picture, picture + picture, part("image", "") + picture}) {
    EXPECT_EQ(refused([&] { form_content(parts); }), "duplicate-parameter image") << parts;
  }
}

TEST(FeatureRequest, TellsAPictureThatWasLostFromNone) {
  EXPECT_TRUE(shows_ground(content_of("image/png", "")));
  EXPECT_TRUE(shows_ground(json_content({{"image", ""}})));
  EXPECT_TRUE(shows_ground(json_content({{"cols", 2}, {"rows", 2}})));
  EXPECT_TRUE(shows_ground(form_content(part("image", ""))));
  EXPECT_FALSE(shows_ground(json_content({{"image", nullptr}, {"cell_m", 2}})));
}

TEST(FeatureRequest, RefusesWhatItWouldNotLookAt) {
  const nlohmann::json cells{{"cell_m", 2}, {"cols", 2}, {"rows", 1}, {"cells", "AP4="}};
  const auto refused_beside = [&](nlohmann::json request) {
    request["image"] = "cGljdHVyZQ==";
    return refused([&] { features_of(json_content(request), {NoRoads(), 2.0}, Limits{}); });
  };
  EXPECT_EQ(refused_beside(cells), "duplicate-parameter cells");
  EXPECT_EQ(refused_beside({{"cell_m", 2}, {"cols", 2}}), "bad-parameter cols");
  EXPECT_EQ(refused_beside({{"kind", "frame"}, {"gsd_m", 1}, {"cells", "AP4="}}), "bad-parameter cells");
  EXPECT_EQ(refused_beside({{"kind", "frame"}, {"gsd_m", 1}, {"rows", 2}}), "bad-parameter rows");
}

TEST(FeatureRequest, TakesCellsRowByRowAsManyAsItSays) {
  const auto seen_in = [](int cols, int rows, const Limits& limits = {}) {
    const nlohmann::json cells{{"cell_m", 2}, {"cols", cols}, {"rows", rows}, {"cells", "AGT+/wEC"}};
    return features_of(json_content(cells), {NoRoads(), 2.0}, limits).map.cells;
  };
  const CellArray cells = seen_in(3, 2);
  EXPECT_EQ(cells.cols(), 3);
  EXPECT_EQ(std::vector(cells.cells().begin(), cells.cells().end()), (std::vector<Cell>{0, 100, 254, 255, 1, 2}));
  EXPECT_EQ(refused([&] { seen_in(3, 3); }), "bad-parameter cells");
  EXPECT_EQ(refused([&] { seen_in(1, 2); }), "bad-parameter cells");
  Limits limits;
  limits.cells = 5;
  EXPECT_EQ(testing::code_of([&] { seen_in(3, 2, limits); }), "too-many-cells");
}

TEST(FeatureRequest, RefusesAFrameOfMorePixelsOrCellsThanAreAllowedAsTheDetectorDrawsThem) {
  class InFinerPixels : public NoRoads {
    double preferred_gsd_m() const override { return 0.5; }
  };
  const auto code = [](const Limits& limits) {
    Content content = json_content({{"kind", "frame"}, {"gsd_m", 2}, {"cell_m", 0.5}});
    give_picture(content, testing::encoded(".png", cv::Mat(20, 30, CV_8UC1, cv::Scalar(128))));
    return testing::code_of([&] { features_of(content, {InFinerPixels(), 2.0}, limits); });
  };
  Limits just;
  just.pixels = 9'600;  // four times finer both ways
  just.cells = 9'600;
  EXPECT_EQ(code(just), "no error");
  Limits fewer_pixels = just;
  --fewer_pixels.pixels;
  EXPECT_EQ(code(fewer_pixels), "ground-too-large");
  Limits fewer_cells = just;
  --fewer_cells.cells;
  EXPECT_EQ(code(fewer_cells), "too-many-cells");
}

constexpr const char* kDrone =
    "drone-dji:RelativeAltitude=\"+40.00\" drone-dji:GimbalYawDegree=\"12\" drone-dji:GimbalPitchDegree=\"-80\" "
    "drone-dji:GimbalRollDegree=\"0\" drone-dji:CalibratedFocalLength=\"30\"";

Content photo(const nlohmann::json& request, const std::string& tags = kDrone) {
  Content content;
  content.fields.add({{"kind", "frame"}}, feature_fields());
  content.fields.add(request, feature_fields());
  give_picture(content, testing::drone_jpeg(cv::Mat(20, 30, CV_8UC1, cv::Scalar(128)), tags));
  return content;
}

Features seen(const Content& content) { return features_of(content, {NoRoads(), 2.0}, Limits{}); }

TEST(FeatureRequest, TakesTheCameraOfAPhotoFromItsFile) {
  const Features told = seen(photo({{"focal_px", 30}, {"agl_m", 40}, {"roll_deg", 0}, {"pitch_deg", 10}}));
  EXPECT_FALSE(told.camera_in_file);
  const Features read = seen(photo({{"exif", true}}));
  EXPECT_NEAR(read.map.nadir.row, told.map.nadir.row, 1e-6);
  EXPECT_NEAR(read.map.nadir_sigma_m, told.map.nadir_sigma_m, 1e-6);
  ASSERT_TRUE(read.camera_in_file);
  EXPECT_DOUBLE_EQ(read.camera_in_file->agl_m, 40.0);
  EXPECT_DOUBLE_EQ(read.camera_in_file->focal_px.value(), 30.0);
  EXPECT_NEAR(read.camera_in_file->pitch.value().degrees(), 10.0, 1e-9);
}

TEST(FeatureRequest, BelievesTheClientMoreThanAPhotosFile) {
  const FrameCamera camera =
      seen(photo({{"exif", true}, {"agl_m", 55}, {"roll_deg", 1}, {"pitch_deg", -2}})).camera_in_file.value();
  EXPECT_DOUBLE_EQ(camera.agl_m, 55.0);
  EXPECT_NEAR(camera.roll.value().degrees(), 1.0, 1e-9);
  EXPECT_NEAR(camera.pitch.value().degrees(), -2.0, 1e-9);
}

TEST(FeatureRequest, RefusesACameraThatIsToldTwiceOrNotAtAll) {
  const auto complaint = [](const nlohmann::json& request) { return refused([&] { seen(photo(request)); }); };
  EXPECT_EQ(complaint({{"exif", true}, {"focal_px", 30}}), "bad-parameter focal_px");
  EXPECT_EQ(complaint({{"exif", true}, {"gsd_m", 1}}), "bad-parameter exif");
  EXPECT_EQ(complaint({{"exif", false}, {"gsd_m", 1}}), "nothing");
  EXPECT_EQ(complaint({{"exif", false}}), "missing-parameter fov_deg");
  const auto code = [](const Content& content) { return testing::code_of([&] { seen(content); }); };
  EXPECT_EQ(code(photo({{"exif", true}}, "")), "camera-not-in-file");
  EXPECT_EQ(code(photo({{"exif", true}}, "drone-dji:CalibratedFocalLength=\"30\"")), "camera-not-in-file");
  Content png = photo({{"exif", true}});
  give_picture(png, encode_feature_map(CellArray(20, 20, kNoRoad)));
  EXPECT_EQ(code(png), "camera-not-in-file");
  give_picture(png, {'n', 'o', 'n', 'e'});
  EXPECT_EQ(code(png), "image-format") << "which is the mistake to mend first";
}

}  // namespace
}  // namespace roadfix::api
