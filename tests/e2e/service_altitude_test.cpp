// Frames of a vehicle that knows its height above the sea, sent to a service whose map knows its ground's.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "tests/e2e/served_town.hpp"
#include "tests/support/drone_jpeg.hpp"
#include "tests/support/encoded.hpp"
#include "tests/support/eventually.hpp"

namespace roadfix {
namespace {

using nlohmann::json;

constexpr double kGroundM = 700.0;

void lay_level_ground(const std::filesystem::path& map, const GridGeometry& town) {
  Terrain terrain = Terrain::unknown(GridGeometry::covering(town.box(), Terrain::kFinestCellM).padded(40));
  for (std::uint16_t& code : terrain.codes) code = Terrain::code_of(kGroundM);
  const UtmZone zone = UtmZone::from_epsg(32634).value();
  MapWriter(map, {zone, town.cell_m}).put_terrain(terrain, {.location = "dem.tif"});
}

cv::Mat noise_frame() {
  cv::Mat frame(400, 400, CV_8UC3);
  cv::randu(frame, 0, 255);
  cv::GaussianBlur(frame, frame, {}, 4.0);
  cv::normalize(frame, frame, 0.0, 255.0, cv::NORM_MINMAX);
  return frame;
}

std::string as_png(const cv::Mat& frame) { return testing::text_of(testing::encoded(".png", frame)); }

class ServiceAltitude : public testing::ServedTown {
 protected:
  static void SetUpTestSuite() {
    testing::ServedTown::SetUpTestSuite();
    const auto unfinished = *folder / "high.unfinished";
    testing::write_map_file(unfinished, town->roads, 2.0);
    lay_level_ground(unfinished, town->roads.geometry);
    std::filesystem::rename(unfinished, *folder / "high.gpkg");
    httplib::Client client = testing::client_of(*service);
    ASSERT_TRUE(testing::eventually([&] { return client.Get("/v1/maps/high")->status == 200; }));
  }

  json fix(const std::string& map, const std::string& height) {
    const std::string prior =
        "&lat=" + std::to_string(town->place.lat_deg) + "&lon=" + std::to_string(town->place.lon_deg) + "&radius_m=100";
    return testing::json_of(
        client_.Post(("/v1/maps/" + map + "/fix?kind=frame&fov_deg=60&roll_deg=0&pitch_deg=0" + prior + height).c_str(),
                     frame_, "image/png"));
  }

  const cv::Mat pixels_ = noise_frame();
  const std::string frame_ = as_png(pixels_);
};

TEST_F(ServiceAltitude, GivesAFrameTheHeightAboveTheGroundOfTheMap) {
  const json by_altitude = fix("high", "&alt_m=1000");
  const json by_height = fix("high", "&agl_m=300");
  ASSERT_FALSE(by_altitude["modes"].empty()) << by_altitude;
  EXPECT_NEAR(by_altitude["modes"][0]["agl_m"].get<double>(), 300.0, 1e-6);
  EXPECT_EQ(by_altitude["modes"][0]["pose"], by_height["modes"][0]["pose"]);
  EXPECT_FALSE(by_height["modes"][0].contains("agl_m"));
  EXPECT_EQ(fix("high", "&agl_m=300&alt_m=5000")["modes"], by_height["modes"]) << "what is told of the ground counts";
}

TEST_F(ServiceAltitude, IsRefusedWhereItCannotBe) {
  EXPECT_EQ(fix("town", "&alt_m=1000")["code"], "terrain-missing");
  EXPECT_EQ(fix("high", "&alt_m=699")["code"], "below-ground");
  EXPECT_EQ(fix("high", "")["code"], "missing-parameter");
}

/// 300 m above its take-off.
std::string photo_of(const cv::Mat& pixels) {
  return testing::text_of(testing::drone_jpeg(
      pixels, R"(drone-dji:RelativeAltitude="+300.00" drone-dji:CalibratedFocalLength="346.41" )"
              R"(drone-dji:GimbalYawDegree="0" drone-dji:GimbalPitchDegree="-90" drone-dji:GimbalRollDegree="0")"));
}

TEST_F(ServiceAltitude, OfAPhotoFollowsFromThatOfItsTakeOff) {
  const std::string photo = photo_of(pixels_);
  const auto fix_photo = [&](const std::string& map, const std::string& told) {
    const std::string prior =
        "&lat=" + std::to_string(town->place.lat_deg) + "&lon=" + std::to_string(town->place.lon_deg) + "&radius_m=100";
    const std::string path = "/v1/maps/" + map + "/fix?kind=frame&exif=true" + prior + told;
    return testing::json_of(client_.Post(path.c_str(), photo, "image/jpeg"));
  };
  const json by_takeoff = fix_photo("high", "&takeoff_alt_m=500");
  const json by_height = fix_photo("high", "&agl_m=100");
  ASSERT_FALSE(by_takeoff["modes"].empty()) << by_takeoff;
  EXPECT_NEAR(by_takeoff["camera"]["agl_m"].get<double>(), 100.0, 1e-6) << "200 m below the ground of the map";
  EXPECT_NEAR(by_takeoff["modes"][0]["agl_m"].get<double>(), 100.0, 1e-6);
  EXPECT_EQ(by_takeoff["modes"][0]["pose"], by_height["modes"][0]["pose"]);
  EXPECT_EQ(fix_photo("high", "")["camera"]["agl_m"], 300.0) << "the ground is taken to be as high as the take-off";
  const json by_altitude = fix_photo("high", "&alt_m=800");
  EXPECT_NEAR(by_altitude["camera"]["agl_m"].get<double>(), 100.0, 1e-6);
  EXPECT_NEAR(by_altitude["modes"][0]["agl_m"].get<double>(), 100.0, 1e-6);
  EXPECT_EQ(by_altitude["modes"][0]["pose"], by_height["modes"][0]["pose"]);
  EXPECT_EQ(fix_photo("high", "&alt_m=5000&takeoff_alt_m=500")["camera"]["agl_m"], by_takeoff["camera"]["agl_m"]);
  EXPECT_EQ(fix_photo("town", "&alt_m=800")["camera"]["agl_m"], 300.0) << "the map knows no heights, but the photo one";
  EXPECT_EQ(fix_photo("town", "&takeoff_alt_m=500")["code"], "terrain-missing");
  EXPECT_EQ(fix_photo("high", "&takeoff_alt_m=399")["code"], "below-ground");
  EXPECT_EQ(fix_photo("high", "&takeoff_alt_m=500&agl_m=100")["field"], "takeoff_alt_m");
}

TEST_F(ServiceAltitude, OfThePhotosOfATrackFollowsFromThatOfTheirTakeOff) {
  const json asked{{"map", "high"}, {"lat", town->place.lat_deg}, {"lon", town->place.lon_deg}, {"radius_m", 100}};
  const json track = testing::json_of(client_.Post("/v1/tracks", asked.dump(), "application/json"));
  const std::string steps = "/v1/tracks/" + track["id"].get<std::string>() + "/steps?takeoff_alt_m=500";
  const std::string seen = steps + "&kind=frame&exif=true&sequence=1&time_us=1";
  const json step = testing::json_of(client_.Post(seen.c_str(), photo_of(pixels_), "image/jpeg"));
  EXPECT_NEAR(step["agl_m"].get<double>(), 100.0, 1e-6) << step;
  const std::string unseen = steps + "&sequence=2&time_us=2";
  EXPECT_EQ(testing::json_of(client_.Post(unseen.c_str(), "{}", "application/json"))["code"], "missing-parameter")
      << "a photo that was forgotten";
}

TEST_F(ServiceAltitude, GivesTheStepsOfATrackTheirsAboveTheGroundBelow) {
  const json asked{{"map", "high"}, {"lat", town->place.lat_deg}, {"lon", town->place.lon_deg}, {"radius_m", 100}};
  const json track = testing::json_of(client_.Post("/v1/tracks", asked.dump(), "application/json"));
  const std::string steps = "/v1/tracks/" + track["id"].get<std::string>() + "/steps?kind=frame&fov_deg=60";
  const auto step = [&](const std::string& more) {
    return testing::json_of(client_.Post((steps + more).c_str(), frame_, "image/png"));
  };
  EXPECT_NEAR(step("&sequence=1&time_us=1&alt_m=1000")["agl_m"].get<double>(), 300.0, 1e-6);
  const json later = step("&sequence=2&time_us=2000000&forward_m=20&right_m=0&turn_deg=0&alt_m=950");
  EXPECT_NEAR(later["agl_m"].get<double>(), 250.0, 1e-6) << later;
  EXPECT_EQ(later["measurement"], "repeated") << "the same picture, whatever its height";
  EXPECT_FALSE(step("&sequence=3&time_us=3000000&agl_m=250&alt_m=950").contains("agl_m"));
  EXPECT_EQ(step("&sequence=4&time_us=4000000&alt_m=100")["code"], "below-ground");
}

TEST_F(ServiceAltitude, TellsAPictureThatComesAgainEncodedAnewAndFromAnotherHeightAndAttitude) {
  const json asked{{"map", "high"}, {"lat", town->place.lat_deg}, {"lon", town->place.lon_deg}, {"radius_m", 100}};
  const json track = testing::json_of(client_.Post("/v1/tracks", asked.dump(), "application/json"));
  const auto step = [&](const cv::Mat& picture, const std::string& told) {
    const std::string path = "/v1/tracks/" + track["id"].get<std::string>() + "/steps?kind=frame&fov_deg=60" + told;
    return testing::json_of(client_.Post(path.c_str(), as_png(picture), "image/png"));
  };
  const std::string moved = "&forward_m=20&right_m=0&turn_deg=0";
  step(pixels_, "&sequence=1&time_us=1&alt_m=1000&roll_deg=0&pitch_deg=0");
  const cv::Mat lighter = 1.02 * pixels_ + cv::Scalar::all(3);
  EXPECT_EQ(step(lighter, "&sequence=2&time_us=2000000&alt_m=990&roll_deg=3&pitch_deg=-2" + moved)["measurement"],
            "useless");
  EXPECT_EQ(step(0.97 * pixels_, "&sequence=3&time_us=3000000&alt_m=980&roll_deg=1&pitch_deg=0" + moved)["measurement"],
            "repeated");
  const cv::Mat other = noise_frame();
  EXPECT_NE(step(other, "&sequence=4&time_us=4000000&alt_m=980&roll_deg=1&pitch_deg=0" + moved)["measurement"],
            "repeated");
}

}  // namespace
}  // namespace roadfix
