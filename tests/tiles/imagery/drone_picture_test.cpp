#include "tiles/imagery/drone_picture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <random>

#include "tests/support/code_of.hpp"
#include "tests/support/drone_jpeg.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::Pair;

const cv::Size kSize{5472, 3648};

auto near_to(double value) { return Optional(DoubleNear(value, 1e-6)); }

DronePicture of_xmp(const Tags& xmp) { return drone_picture({{}, xmp, kSize}); }
DronePicture of_exif(const Tags& exif, cv::Size size = kSize) { return drone_picture({exif, {}, size}); }

/// Right-handed, as rotations of north, east and down (NED) are written.
cv::Matx33d about(int axis, double degrees) {
  const Angle angle = Angle::degrees(degrees);
  const double c = cos(angle);
  const double s = sin(angle);
  if (axis == 0) return {1, 0, 0, 0, c, -s, 0, s, c};
  if (axis == 1) return {c, 0, s, 0, 1, 0, -s, 0, c};
  return {c, -s, 0, s, c, 0, 0, 0, 1};
}

/// Of FrameCamera: its axes right, back and down in NED.
cv::Matx33d axes_of(const DronePicture& picture) {
  FrameCamera camera;
  camera.roll = picture.roll;
  camera.pitch = picture.pitch;
  const double c = cos(picture.heading.value());
  const double s = sin(picture.heading.value());
  return cv::Matx33d{-s, -c, 0, c, -s, 0, 0, 0, 1} * level_from_camera(camera);
}

TEST(DronePicture, LooksWhereItsGimbalPointed) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-180.0, 180.0);
  std::uniform_real_distribution<double> down(-150.0, -30.0);
  for (int i = 0; i < 200; ++i) {
    const double yaw = any(random);
    const double pitch = down(random);
    const double roll = i % 4 == 0 ? 180.0 : any(random) / 9.0;
    const DronePicture picture = of_xmp({{"GimbalYawDegree", fmt::format("{:+.9f}", yaw)},
                                         {"GimbalPitchDegree", fmt::format("{:+.9f}", pitch)},
                                         {"GimbalRollDegree", fmt::format("{:+.9f}", roll)}});
    const cv::Matx33d gimbal = about(2, yaw) * about(1, pitch) * about(0, roll);  // ahead, right, down of the picture
    const cv::Matx33d expected = gimbal * cv::Matx33d{0, 0, 1, 1, 0, 0, 0, 1, 0};
    EXPECT_LT(cv::norm(axes_of(picture) - expected), 1e-6) << yaw << ' ' << pitch << ' ' << roll;
  }
}

TEST(DronePicture, HasTheSameAttitudeByBothTriplesOfParrot) {
  // The examples of Parrot's table of photo metadata (ANAFI Ai), one by its own tags and one by those of Pix4D.
  const DronePicture by_parrot = of_xmp(
      {{"CameraYawDegree", "146.848038"}, {"CameraPitchDegree", "-51.988888"}, {"CameraRollDegree", "-0.052789"}});
  const DronePicture by_pix4d =
      of_xmp({{"Camera:Yaw", "146.781036"}, {"Camera:Pitch", "38.011101"}, {"Camera:Roll", "-0.041258"}});
  EXPECT_LT(cv::norm(axes_of(by_parrot) - axes_of(by_pix4d)), 1e-5);
}

TEST(DronePicture, HasNoAttitudeOfWhichAnAngleIsMissingOrMeansSomethingElse) {
  for (const Tags& xmp :
       {Tags{{"GimbalYawDegree", "12"}, {"GimbalPitchDegree", "-80"}},
        Tags{{"Camera:Yaw", "12"}, {"Camera:Pitch", "8"}}, Tags{{"Yaw", "12"}, {"Pitch", "2"}, {"Roll", "1"}}}) {
    const DronePicture picture = of_xmp(xmp);
    EXPECT_FALSE(picture.heading || picture.roll || picture.pitch) << xmp.begin()->first;
  }
}

TEST(DronePicture, TakesTheAnglesOfPix4dAsTheyAre) {
  const DronePicture picture = of_xmp({{"Camera:Yaw", "-92.7"}, {"Camera:Pitch", "3.1"}, {"Camera:Roll", "-1.5"}});
  EXPECT_NEAR(picture.heading.value().degrees(), -92.7, 1e-9);
  EXPECT_NEAR(picture.pitch.value().degrees(), 3.1, 1e-9);
  EXPECT_NEAR(picture.roll.value().degrees(), -1.5, 1e-9);
}

TEST(DronePicture, TellsHeightAboveGroundFromHeightAboveTheTakeOff) {
  EXPECT_THAT(of_xmp({{"RelativeAltitude", "+98.30"}}).takeoff_m, near_to(98.3));
  EXPECT_FALSE(of_xmp({{"RelativeAltitude", "+98.30"}}).agl_m);
  EXPECT_THAT(of_xmp({{"Camera:AboveGroundAltitude", "81.2"}}).agl_m, near_to(81.2));
  EXPECT_THAT(of_xmp({{"Camera:AboveGroundAltitude", "11485529/262144"}}).agl_m, near_to(43.813816))
      << "as Parrot writes it";
  EXPECT_FALSE(of_xmp({{"AbsoluteAltitude", "+698.30"}}).agl_m) << "which is above the sea";
}

TEST(DronePicture, WasTakenWhereExifOrElseXmpSays) {
  Tags exif{{"EXIF_GPSLatitude", "(33) (51) (54)"},
            {"EXIF_GPSLatitudeRef", "S"},
            {"EXIF_GPSLongitude", "(70) (39) (0.36)"},
            {"EXIF_GPSLongitudeRef", "W"}};
  const DronePicture picture = of_exif(exif);
  EXPECT_NEAR(picture.place.value().lat_deg, -33.865, 1e-9);
  EXPECT_NEAR(picture.place.value().lon_deg, -70.6501, 1e-9);
  exif.erase("EXIF_GPSLongitudeRef");
  EXPECT_FALSE(of_exif(exif).place);
  EXPECT_NEAR(of_xmp({{"GpsLatitude", "+37.76"}, {"GpsLongitude", "-38.25"}}).place.value().lon_deg, -38.25, 1e-9);
  EXPECT_FALSE(of_xmp({{"GpsLatitude", "0.0"}, {"GpsLongitude", "0.0"}}).place) << "no satellites were received";
  EXPECT_FALSE(of_xmp({{"GpsLatitude", "97"}, {"GpsLongitude", "3"}}).place);
}

TEST(DronePicture, WasTakenNowhereWhereItsDegreesAreToldToSixDigitsOnly) {
  Tags exif{{"EXIF_GPSLatitude", "(37.7599) (0) (0)"},
            {"EXIF_GPSLatitudeRef", "S"},
            {"EXIF_GPSLongitude", "(126.123) (0) (0)"},
            {"EXIF_GPSLongitudeRef", "E"}};
  EXPECT_FALSE(of_exif(exif).place) << "up to 55 m off";
  const Tags xmp{{"GpsLatitude", "-37.7599041"}, {"GpsLongitude", "+126.1234567"}};
  EXPECT_NEAR(drone_picture({exif, xmp, kSize}).place.value().lon_deg, 126.1234567, 1e-9);
  exif["EXIF_GPSLatitude"] = "(38) (0) (0)";
  EXPECT_FALSE(of_exif(exif).place) << "its longitude alone is cut";
  exif["EXIF_GPSLongitude"] = "(126) (7.40741) (0)";
  EXPECT_NEAR(of_exif(exif).place.value().lon_deg, 126.1234568, 1e-7) << "10 cm are nothing to speak of";
  EXPECT_EQ(of_exif(exif).place.value().lat_deg, -38.0);
}

TEST(DronePicture, CountsTimeToTheFractionOfASecond) {
  EXPECT_THAT(of_exif({{"EXIF_DateTimeOriginal", "2023:02:09 11:05:10"}, {"EXIF_SubSecTime_Original", "25"}}).time_s,
              near_to(1675940710.25));
  EXPECT_FALSE(of_exif({{"EXIF_DateTimeOriginal", "2023:02:31 11:05:10"}}).time_s);
  EXPECT_FALSE(of_exif({{"EXIF_DateTimeOriginal", "2023:02:-9 11:05:10"}}).time_s);
  EXPECT_FALSE(of_exif({{"EXIF_DateTimeOriginal", "2023:258:09 11:05:10"}}).time_s);
  EXPECT_FALSE(of_exif({{"EXIF_DateTimeOriginal", "2023:02:265 11:05:10"}}).time_s);
  EXPECT_FALSE(of_exif({{"EXIF_DateTimeOriginal", "2023:02:09 24:05:10"}}).time_s);
}

TEST(DronePicture, HasTheLensOfItsCalibrationUntilItsDistortionIsTakenOut) {
  Tags xmp{{"DewarpFlag", "0"},
           {"DewarpData", "2021-05-11;3713.29,3712,7.5,-8.5,-0.112,0.015,0.0001,-0.0003,-0.028"},
           {"CalibratedFocalLength", "3666.666504"}};
  const DronePicture bent = of_xmp(xmp);
  EXPECT_THAT(bent.focal_px, near_to(3713.29));
  EXPECT_EQ(bent.principal_px, cv::Point2d(2743.0, 1815.0));
  EXPECT_THAT(bent.distortion, ElementsAre(-0.112, 0.015, 0.0001, -0.0003, -0.028));
  xmp["DewarpFlag"] = "1";
  const DronePicture straight = of_xmp(xmp);
  EXPECT_THAT(straight.focal_px, near_to(3666.666504));
  EXPECT_FALSE(straight.principal_px);
  EXPECT_THAT(straight.distortion, IsEmpty());
}

TEST(DronePicture, HasTheLensOfItsCalibrationInThePixelsThatItHas) {
  const Tags exif{{"EXIF_PixelXDimension", "5472"}, {"EXIF_PixelYDimension", "3648"}};
  const Tags xmp{{"DewarpFlag", "0"}, {"DewarpData", "2021-05-11;3712,3712,8,-6,-0.112,0.015,0.0001,-0.0003,-0.028"}};
  const DronePicture smaller = drone_picture({exif, xmp, {1368, 912}});
  EXPECT_THAT(smaller.focal_px, near_to(928.0));
  EXPECT_EQ(smaller.principal_px, cv::Point2d(683.5 + 2.0, 455.5 - 1.5)) << "from the middle of the picture";
}

TEST(DronePicture, IsAsHighAsItIsToldOrElseAboveTheGroundOrElseAboveTheTakeOff) {
  DronePicture picture = drone_picture({{{"EXIF_FocalLengthIn35mmFilm", "24"}}, {}, kSize});
  const auto agl_m = [&](std::optional<double> told_m) { return camera_of(picture, {told_m, Angle(), Angle()}).agl_m; };
  EXPECT_EQ(testing::code_of([&] { agl_m({}); }), "camera-not-in-file");
  picture.takeoff_m = 98.0;
  EXPECT_EQ(agl_m({}), 98.0);
  picture.agl_m = 81.0;
  EXPECT_EQ(agl_m({}), 81.0);
  EXPECT_EQ(agl_m(70.0), 70.0);
}

TEST(DronePicture, IsHigherAboveGroundThatLiesLowerThanItsTakeOff) {
  DronePicture picture = drone_picture({{{"EXIF_FocalLengthIn35mmFilm", "24"}}, {}, kSize});
  const KnownView known{{}, Angle(), Angle(), 30.0};
  picture.agl_m = 81.0;
  EXPECT_EQ(testing::code_of([&] { camera_of(picture, known); }), "camera-not-in-file") << "higher than what?";
  picture.takeoff_m = -12.0;
  EXPECT_EQ(camera_of(picture, known).agl_m, 18.0);
}

TEST(DronePicture, LookedWhereItIsToldOrElseWhereItsFileSays) {
  const DronePicture picture = drone_picture({{{"EXIF_FocalLengthIn35mmFilm", "24"}},
                                              {{"Camera:Yaw", "0"}, {"Camera:Pitch", "3"}, {"Camera:Roll", "-2"}},
                                              kSize});
  const FrameCamera by_file = camera_of(picture, {100.0, {}, {}});
  EXPECT_NEAR(by_file.pitch.value().degrees(), 3.0, 1e-9);
  EXPECT_NEAR(by_file.roll.value().degrees(), -2.0, 1e-9);
  const FrameCamera told = camera_of(picture, {100.0, Angle::degrees(5.0), Angle::degrees(-6.0)});
  EXPECT_NEAR(told.roll.value().degrees(), 5.0, 1e-9);
  EXPECT_NEAR(told.pitch.value().degrees(), -6.0, 1e-9);
  EXPECT_FALSE(told.attitude_sigma);
  EXPECT_EQ(camera_of(picture, {100.0, {}, {}, {}, Angle::degrees(0.5)}).attitude_sigma, Angle::degrees(0.5));
}

TEST(DronePicture, HasTheFocalLengthOfItsFieldOfViewInThePixelsThatItHas) {
  Tags exif{{"EXIF_FocalLengthIn35mmFilm", "24"}};
  EXPECT_THAT(of_exif(exif).focal_px, Optional(DoubleNear(3648.0, 1.0)));  // 8.8 mm on 13.2 x 8.8 mm
  exif["EXIF_PixelXDimension"] = "5472";
  exif["EXIF_PixelYDimension"] = "3648";
  EXPECT_THAT(of_exif(exif, {1368, 912}).focal_px, Optional(DoubleNear(912.0, 0.3))) << "made smaller";
  EXPECT_FALSE(of_exif(exif, {1000, 1000}).focal_px) << "cut";
  const Tags xmp{{"CalibratedFocalLength", "3666"}};
  EXPECT_THAT(drone_picture({exif, xmp, {1368, 912}}).focal_px, near_to(916.5));
}

/// Its code, or "no error".
std::string refusal(const Tags& exif, const Tags& xmp, cv::Size size = kSize) {
  return testing::code_of([&] { camera_of(drone_picture({exif, xmp, size}), {100.0, Angle(), Angle()}); });
}

TEST(DronePicture, TellsNoCameraWhereNobodyKnowsWhereItLooked) {
  const DronePicture picture = drone_picture({{{"EXIF_FocalLengthIn35mmFilm", "24"}}, {}, kSize});
  const auto refused_with = [&](std::optional<Angle> roll, std::optional<Angle> pitch) {
    return testing::code_of([&] { camera_of(picture, {100.0, roll, pitch}); });
  };
  EXPECT_EQ(refused_with({}, {}), "camera-not-in-file");
  EXPECT_EQ(refused_with({}, Angle()), "camera-not-in-file");
  EXPECT_EQ(refused_with(Angle(), {}), "camera-not-in-file");
  EXPECT_EQ(refused_with(Angle(), Angle()), "no error");
}

TEST(DronePicture, TellsNoCameraWhereItsCalibrationIsForMorePixelsThanItHas) {
  const Tags exif{{"EXIF_FocalLengthIn35mmFilm", "24"}};
  const Tags dewarped{{"DewarpFlag", "0"}, {"DewarpData", "2021-05-11;3713,3712,7,-8,-0.1,0,0,0,0"}};
  for (const Tags& xmp : {Tags{{"CalibratedFocalLength", "3666"}}, dewarped}) {
    EXPECT_EQ(refusal(exif, xmp), "no error");
    EXPECT_EQ(refusal(exif, xmp, {2736, 1824}), "camera-contradictory") << "its size was dropped";
    EXPECT_FALSE(drone_picture({exif, xmp, {2736, 1824}}).focal_px);
    EXPECT_EQ(refusal({}, xmp, {2736, 1824}), "no error") << "nothing contradicts";
  }
  EXPECT_THAT(drone_picture({exif, {{"CalibratedFocalLength", "3666"}}, {2736, 1824}}).doubt.value().what,
              AllOf(HasSubstr("3666 pixels by its calibration"), HasSubstr("1824 by FocalLengthIn35mmFilm")));
}

TEST(DronePicture, BelievesItsCalibrationWhereTheCutAndTheConventionsOfFilmDiffer) {
  const double focal_px = 3000.0;  // on 4000 x 3000 pixels, the sensor's
  for (const double film_mm : {43.2666 / 5000.0 * focal_px, 36.0 / 4000.0 * focal_px}) {
    const Tags exif{{"EXIF_FocalLengthIn35mmFilm", fmt::format("{:.0f}", film_mm)}};
    for (const cv::Size size : {cv::Size(4000, 3000), cv::Size(4000, 2666), cv::Size(4000, 2250)}) {
      EXPECT_THAT(drone_picture({exif, {{"CalibratedFocalLength", "3000"}}, size}).focal_px, near_to(3000.0)) << size;
    }
  }
}

TEST(DronePicture, TellsNoCameraWhereTheCameraEnlargedWhatItSaw) {
  for (const char* focal : {"CalibratedFocalLength", "EXIF_FocalLengthIn35mmFilm"}) {
    Tags tags{{focal, "3666"}, {"EXIF_DigitalZoomRatio", "(2)"}};
    EXPECT_EQ(refusal(tags, tags), "camera-zoomed");
    for (const char* none : {"(1)", "(0)", "(nan)"}) {
      tags["EXIF_DigitalZoomRatio"] = none;
      EXPECT_EQ(refusal(tags, tags), "no error") << none;
    }
  }
}

std::string description(const std::string& inner) {
  return R"(<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">)" +
         inner + "</rdf:RDF></x:xmpmeta>";
}

TEST(XmpTags, AreAttributesAndElementsWithoutTheirPrefixes) {
  const Tags tags = tags_of_xmp(description(
      R"(<rdf:Description drone-dji:RelativeAltitude="+9"/><rdf:Description xmlns:drone="d">)"
      R"(<drone:GimbalPitchDegree rdf:parseType="Literal">-80</drone:GimbalPitchDegree></rdf:Description>)"));
  EXPECT_EQ(tags.at("RelativeAltitude"), "+9");
  EXPECT_EQ(tags.at("GimbalPitchDegree"), "-80");
  EXPECT_THAT(tags_of_xmp("no <xml"), IsEmpty());
}

TEST(XmpTags, AreOfTheCameraByItsNamespaceWhateverThePrefix) {
  for (const char* space : {"http://pix4d.com/camera/1.0/", "http://pix4d.com/camera/1.0",  //
                            "http://ns.sensefly.com/Camera/1.0/"}) {
    const Tags tags = tags_of_xmp(description(fmt::format(
        R"(<rdf:Description xmlns:a="{0}" a:Yaw="3"><b:Pitch xmlns:b="{0}">4</b:Pitch></rdf:Description>)", space)));
    EXPECT_EQ(tags.at("Camera:Yaw"), "3") << space;
    EXPECT_EQ(tags.at("Camera:Pitch"), "4") << space;
  }
  EXPECT_THAT(tags_of_xmp(description(R"(<rdf:Description xmlns:Camera="http://a.net" Camera:Yaw="3" b:Yaw="4"/>)")),
              ElementsAre(Pair("Yaw", "3")));
}

TEST(XmpTags, AreNotTheFieldsOfStructures) {
  // One drone writes the attitudes of itself and its camera so, of which neither counts from straight down.
  const Tags tags = tags_of_xmp(description(
      R"(<rdf:Description xmlns:s="http://pix4d.com/camera/1.0/"><s:Vehicle rdf:parseType="Resource"><s:Yaw>200</s:Yaw>)"
      R"(</s:Vehicle><s:Gimbal><rdf:Description s:Yaw="200"/></s:Gimbal><s:Roll>1</s:Roll></rdf:Description>)"));
  EXPECT_FALSE(tags.contains("Camera:Yaw"));
  EXPECT_EQ(tags.at("Camera:Roll"), "1");
}

TEST(PictureTags, AreReadFromMemoryAsFromAFile) {
  const auto jpeg =
      testing::drone_jpeg(cv::Mat(90, 120, CV_8UC1, cv::Scalar(128)), "drone-dji:RelativeAltitude=\"+9\"");
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "a.jpg", std::ios::binary)
      .write(reinterpret_cast<const char*>(jpeg.data()), static_cast<std::streamsize>(jpeg.size()));
  for (const PictureTags& tags : {read_picture_tags(jpeg), read_picture_tags((folder / "a.jpg").string())}) {
    EXPECT_EQ(tags.xmp.at("RelativeAltitude"), "+9");
    EXPECT_EQ(tags.size, cv::Size(120, 90));
  }
}

TEST(PictureTags, AreNoneOfWhatIsNoJpeg) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", cv::Mat(9, 9, CV_8UC1, cv::Scalar(1)), bytes);
  for (std::size_t size : {std::size_t{0}, std::size_t{3}, bytes.size()}) {
    const PictureTags tags = read_picture_tags(std::span(bytes).first(size));
    EXPECT_THAT(tags.xmp, IsEmpty());
    EXPECT_THAT(tags.exif, IsEmpty());
  }
}

}  // namespace
}  // namespace roadfix
