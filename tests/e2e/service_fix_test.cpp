// Where a UAV is, asked of the real program over real sockets.
#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/detect/model_files.hpp"
#include "server/api/base64.hpp"
#include "tests/e2e/served_town.hpp"
#include "tests/support/drone_jpeg.hpp"

namespace roadfix {
namespace {

using nlohmann::json;

class ServiceFix : public testing::ServedTown {
 protected:
  static std::string place(double radius_m = 300.0) {
    return "&lat=" + std::to_string(town->place.lat_deg) + "&lon=" + std::to_string(town->place.lon_deg) +
           "&radius_m=" + std::to_string(radius_m);
  }
  static void expect_pose(const json& pose, LatLon at, double heading_deg, double metres, double degrees) {
    const GridPoint truth = town->zone.project(at);
    EXPECT_LT(distance_m(town->zone.project({pose["lat"], pose["lon"]}), truth), metres);
    EXPECT_LT(angular_distance(Angle::degrees(pose["heading_deg"]), Angle::degrees(heading_deg)).degrees(), degrees);
  }
};

TEST_F(ServiceFix, ReturnsThePoseOfAWindowThatIsPostedBackAsItIs) {
  const double heading = 37.3;
  const auto png = client_.Get(window_query(heading), {{"Accept", "image/png"}});
  ASSERT_EQ(png->get_header_value("Content-Type"), "image/png");
  const json by_png = testing::json_of(client_.Post("/v1/maps/town/fix?cell_m=2" + place(), png->body, "image/png"));
  ASSERT_EQ(by_png["status"], "fix") << by_png;
  expect_pose(by_png["pose"], town->place, heading, 1.0, 1.0);

  const auto window = client_.Get(window_query(heading) + "&format=json");
  const json by_json = testing::json_of(client_.Post("/v1/maps/town/fix", window->body, "application/json"));
  ASSERT_EQ(by_json["status"], "fix") << by_json;
  expect_pose(by_json["pose"], town->place, heading, 1.0, 1.0);
}

TEST_F(ServiceFix, FixesAFeatureMapFromEveryKindOfBody) {
  const std::string seen = town->seen();
  const httplib::MultipartFormDataItems form{{"image", seen, "seen.png", "image/png"},
                                             {"request", R"({"cell_m":2})", "", "application/json"}};
  const httplib::MultipartFormDataItems plain_form{{"image", seen, "seen.png", "image/png"}, {"cell_m", "2", "", ""}};
  for (const httplib::Result& answer :
       {client_.Post("/v1/maps/town/fix?cell_m=2", seen, "image/png"), client_.Post("/v1/maps/town/fix", form),
        client_.Post("/v1/maps/town/fix", plain_form)}) {
    const json fix = testing::json_of(answer);
    ASSERT_EQ(fix["status"], "fix") << fix;
    expect_pose(fix["pose"], town->place, town->heading_deg, 6.0, 2.0);
    EXPECT_EQ(fix["map"]["name"], "town");
    EXPECT_EQ(fix["geometry"]["type"], "Point");
    EXPECT_GT(fix["probability"], 0.99);
  }
}

TEST_F(ServiceFix, GivesAFixInTheWordsOfAutopilots) {
  const std::string seen = town->seen();
  const std::string url = "/v1/maps/town/fix?cell_m=2&time_us=5000000" + place() + "&format=";
  const json input = testing::json_of(client_.Post(url + "mavproxy", seen, "image/png"));
  EXPECT_EQ(input["fix_type"], 2);
  EXPECT_NEAR(1e-7 * input["lat"].get<double>(), town->place.lat_deg, 1e-4);
  EXPECT_EQ(input["time_usec"], 5'000'000);
  EXPECT_EQ(client_.Post(url + "global_position_sensor", seen, "image/png")->body.substr(7, 3),
            std::string("\x28\x01\x00", 3))
      << "message 296";
  const std::string empty = testing::text_of(encode_feature_map(CellArray(128, 128, kNoRoad)));
  const auto none = client_.Post(url + "command_int", empty, "image/png");
  EXPECT_EQ(none->status, 204);
  EXPECT_EQ(none->get_header_value("Roadfix-Status"), "no_fix");
}

TEST_F(ServiceFix, LaysFramesOfAFlightTogether) {
  const auto base64 = [](const std::string& bytes) {
    return api::base64_encoded({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  };
  const double forward_m = -120.0;
  const GridPose earlier{{town->pose.position.east_m + sin(town->pose.heading) * forward_m,
                          town->pose.position.north_m + cos(town->pose.heading) * forward_m},
                         town->pose.heading + Angle::degrees(15)};
  json request{{"cell_m", 2}, {"image", base64(town->seen_from(town->pose, 100))}};
  const json alone = testing::json_of(client_.Post("/v1/maps/town/fix", request.dump(), "application/json"));
  const json frame{
      {"image", base64(town->seen_from(earlier, 100))}, {"forward_m", forward_m}, {"right_m", 0}, {"turn_deg", 15}};
  request["also"] = json::array({frame});
  const json fix = testing::json_of(client_.Post("/v1/maps/town/fix", request.dump(), "application/json"));
  ASSERT_FALSE(fix["modes"].empty()) << fix;
  expect_pose(fix["modes"][0]["pose"], town->place, town->heading_deg, 6.0, 2.0);
  EXPECT_GT(fix["modes"][0]["observed_cells"], 1.3 * alone["modes"][0]["observed_cells"].get<double>());
  EXPECT_FALSE(fix.contains("left_out"));

  const json strayed{{"image", base64(town->seen_from(moved(town->pose, {-60.0, 0.0, {}}), 100))},
                     {"forward_m", -60},
                     {"right_m", 90},
                     {"turn_deg", 0}};
  request["also"] = json::array({frame, strayed});
  const json rest = testing::json_of(client_.Post("/v1/maps/town/fix", request.dump(), "application/json"));
  EXPECT_EQ(rest["left_out"], json::array({3})) << rest;
  expect_pose(rest["modes"][0]["pose"], town->place, town->heading_deg, 6.0, 2.0);

  const auto refusal = [&](const json& also) {
    request["also"] = also;
    return testing::refusal(client_.Post("/v1/maps/town/fix", request.dump(), "application/json"));
  };
  EXPECT_EQ(refusal(7), "400 bad-parameter also");
  EXPECT_EQ(refusal(json::array({frame, 7})), "400 bad-parameter also[1]");
  EXPECT_EQ(refusal(json(std::vector<json>(16, frame))), "413 too-many-frames");
  json bent = frame;
  bent["turn_deg"] = "left";
  EXPECT_EQ(refusal(json::array({bent})), "400 bad-parameter also[0].turn_deg");
  bent = frame;
  bent["image"] = "!";
  EXPECT_EQ(refusal(json::array({bent})), "400 bad-base64 also[0].image");
  bent["image"] = base64("no picture");
  request["also"] = json::array({frame, bent});
  const json problem = testing::json_of(client_.Post("/v1/maps/town/fix", request.dump(), "application/json"));
  EXPECT_EQ(problem["code"], "image-format");
  EXPECT_EQ(problem["detail"].get<std::string>().substr(0, 14), "also[1].image:") << problem;
  json by_cells{{"cell_m", 2}, {"cols", 2}, {"rows", 1}, {"cells", "AP4="}, {"also", json::array({frame})}};
  const json mixed = testing::json_of(client_.Post("/v1/maps/town/fix", by_cells.dump(), "application/json"));
  EXPECT_THAT(mixed["detail"].get<std::string>(), ::testing::HasSubstr("beside 'also'"));
  bent = frame;
  bent["right_m"] = bent["forward_m"] = 9e4;
  EXPECT_EQ(refusal(json::array({bent})), "413 frames-too-far-apart");
}

TEST_F(ServiceFix, SearchesOnlyWhereThePriorAllows) {
  const std::string seen = town->seen();
  const json near = testing::json_of(client_.Post(
      "/v1/maps/town/fix?cell_m=2&heading_range_deg=20&heading_deg=" + std::to_string(town->heading_deg) + place(100),
      seen, "image/png"));
  EXPECT_EQ(near["status"], "fix") << near;
  EXPECT_LT(near["searched"]["area_km2"], 0.05);
  EXPECT_EQ(testing::refusal(client_.Post("/v1/maps/town/fix?cell_m=2&lat=10&lon=20&radius_m=50", seen, "image/png")),
            "422 prior-outside-map");
}

TEST_F(ServiceFix, RefusesAWrongPriorBeforeItLooksForRoads) {
  const std::string url = "/v1/maps/town/fix?kind=frame&gsd_m=0.5&lat=10&lon=20&radius_m=50";
  EXPECT_EQ(testing::refusal(client_.Post(url, "no picture", "image/png")), "422 prior-outside-map");
}

TEST_F(ServiceFix, FixesWhatWasSeenFromAnAltitudeKnownRoughly) {
  // The cells of 2 m are said to be of 2.2 m.
  const std::string url = "/v1/maps/town/fix?cell_m=2.2&scale_range=";
  const json fix = testing::json_of(client_.Post(url + "0.15" + place(), town->seen(), "image/png"));
  ASSERT_EQ(fix["status"], "fix") << fix;
  expect_pose(fix["pose"], town->place, town->heading_deg, 6.0, 2.0);
  EXPECT_NEAR(fix["scale"].get<double>(), 1.0 / 1.1, 0.02);
  EXPECT_GT(fix["searched"]["scales"], 1);
  EXPECT_EQ(testing::refusal(client_.Post(url + "0.5", town->seen(), "image/png")),
            "400 parameter-out-of-range scale_range");
}

TEST_F(ServiceFix, SaysWhatItHasWhereTheTimeLimitEndsTheSearch) {
  const std::string url = "/v1/maps/town/fix?cell_m=2&time_limit_s=";
  const auto answer = client_.Post(url + "0.001", town->seen(), "image/png");
  ASSERT_EQ(answer->status, 200);
  const json fix = testing::json_of(answer);
  EXPECT_EQ(fix["status"], "no_fix");
  EXPECT_EQ(fix["reason"], "search-time-limit");
  EXPECT_EQ(fix["searched"]["complete"], false);
  EXPECT_LT(fix["searched"]["share"], 1.0);
  EXPECT_EQ(testing::refusal(client_.Post(url + "0", town->seen(), "image/png")),
            "400 parameter-out-of-range time_limit_s");
  const json whole = testing::json_of(client_.Post(url + "600", town->seen(), "image/png"));
  EXPECT_EQ(whole["searched"]["complete"], true) << whole;
  EXPECT_EQ(whole["searched"]["share"], 1.0);
}

TEST_F(ServiceFix, SaysBeforeTheFlightWhatAFrameOfAPlaceWouldGive) {
  const json answer = testing::json_of(client_.Get("/v1/maps/town/localizability?footprint_m=500&radius_m=300" +
                                                   std::string("&lat=") + std::to_string(town->place.lat_deg) +
                                                   "&lon=" + std::to_string(town->place.lon_deg)));
  EXPECT_EQ(answer["status"], "fix") << answer;
  EXPECT_GT(answer["probability"], 0.9);
  EXPECT_GT(answer["road_share"], 0.0);
  EXPECT_EQ(answer["map"]["name"], "town");
  EXPECT_EQ(testing::refusal(client_.Get("/v1/maps/town/localizability?footprint_m=3&lat=10&lon=20")),
            "400 parameter-out-of-range footprint_m");
}

TEST_F(ServiceFix, SaysBeforeTheFlightWhereAlongARouteFramesWouldGiveAFix) {
  const double lon_deg = town->place.lon_deg;
  const json line{{"type", "LineString"},
                  {"coordinates", {{lon_deg, town->place.lat_deg}, {lon_deg + 0.1, town->place.lat_deg}}}};
  const std::string url = "/v1/maps/town/localizability?footprint_m=300&radius_m=300&places=20";
  const json whole = testing::json_of(client_.Post(url, line.dump(), "application/geo+json"));
  EXPECT_EQ(whole["complete"], true);
  EXPECT_EQ(whole["features"].size(), 20U);
  EXPECT_EQ(whole["features"][0]["properties"]["place"], "distinct") << whole["features"][0];
  EXPECT_EQ(whole["features"][19]["properties"]["place"], "unknown") << "6 km away";
  EXPECT_EQ(whole["longest_without_fix"]["to_m"], whole["length_m"]);
  EXPECT_EQ(whole["map"]["name"], "town");

  const json begin = testing::json_of(client_.Post(url + "&limit=3", line.dump(), "application/geo+json"));
  EXPECT_EQ(begin["features"].size(), 3U);
  EXPECT_EQ(begin["complete"], false);
  const std::string from_m = begin["next_m"].dump();
  const json rest = testing::json_of(client_.Post(url + "&from_m=" + from_m, line.dump(), "application/geo+json"));
  ASSERT_EQ(rest["features"].size(), 17U);
  EXPECT_EQ(rest["features"][0], whole["features"][3]);
  EXPECT_EQ(rest["complete"], true);

  EXPECT_EQ(testing::refusal(client_.Post(url, line.dump(), "image/png")), "415 unsupported-media-type Content-Type");
  EXPECT_EQ(
      testing::refusal(client_.Post(url, R"({"type":"LineString","coordinates":[[1,1],[2,2]]})", "application/json")),
      "422 route-outside-map");
  EXPECT_EQ(testing::refusal(client_.Post(url + "&from_m=100000", line.dump(), "application/json")),
            "400 parameter-out-of-range from_m");
  EXPECT_EQ(testing::refusal(client_.Post(url, std::string(2'000'000, ' '), "text/plain")), "413 route-too-long");
}

TEST_F(ServiceFix, SaysBeforeTheFlightWhatACameraShowsFromTheHeightsOfARoute) {
  const double lon_deg = town->place.lon_deg;
  const auto mission = [&](int frame) {
    json items;
    for (const double east_deg : {0.0, 0.005}) {
      items.push_back({{"type", "SimpleItem"},
                       {"command", 16},
                       {"frame", frame},
                       {"params", {0, 0, 0, 0, town->place.lat_deg, lon_deg + east_deg, 150}}});
    }
    return json{{"fileType", "Plan"}, {"mission", {{"items", items}}}}.dump();
  };
  const std::string url = "/v1/maps/town/localizability?radius_m=300&places=2";
  const auto ask = [&](const std::string& camera, int frame) {
    return client_.Post(url + camera, mission(frame), "application/json");
  };
  // Across 90 degrees: 300 m.
  const json found = testing::json_of(ask("&fov_deg=90&aspect=1", 3));
  ASSERT_EQ(found["features"].size(), 2U) << found;
  EXPECT_NEAR(found["features"][0]["properties"]["footprint_m"].get<double>(), 300.0, 1e-6);
  EXPECT_NEAR(found["agl_range_m"][1].get<double>(), 150.0, 1e-6);
  const json fixed = testing::json_of(ask("&footprint_m=300", 3));
  EXPECT_EQ(fixed["features"][0]["properties"]["place"], found["features"][0]["properties"]["place"]);
  EXPECT_FALSE(fixed["features"][0]["properties"].contains("footprint_m"));

  EXPECT_EQ(testing::refusal(ask("&fov_deg=90", 0)), "422 terrain-missing");
  EXPECT_EQ(testing::refusal(ask("&fov_deg=90", 2)), "422 heights-missing");
  EXPECT_EQ(testing::json_of(ask("&fov_deg=90&aspect=1&agl_m=150", 2))["footprint_range_m"],
            found["footprint_range_m"]);
  EXPECT_EQ(testing::refusal(ask("&fov_deg=90&footprint_m=300", 3)), "400 bad-parameter footprint_m");
  EXPECT_EQ(testing::refusal(ask("&footprint_m=300&agl_m=150", 3)), "400 missing-parameter fov_deg");
  EXPECT_EQ(testing::refusal(ask("", 3)), "400 missing-parameter footprint_m");
}

TEST_F(ServiceFix, ScoresPosesInTheirOrder) {
  json request = testing::json_of(client_.Get(window_query(120.0) + "&format=json"));
  json elsewhere = request["pose"];
  elsewhere["heading_deg"] = 10.0;
  json far = request["pose"];
  far["lat"] = far["lat"].get<double>() + 1.0;
  request["poses"] = {request["pose"], elsewhere, far};
  const json scores =
      testing::json_of(client_.Post("/v1/maps/town/match", request.dump(), "application/json"))["scores"];
  ASSERT_EQ(scores.size(), 3U);
  EXPECT_GT(scores[0]["rho"], 0.8);
  EXPECT_LT(scores[1]["rho"], 0.5);
  EXPECT_TRUE(scores[2]["rho"].is_null());
  EXPECT_EQ(scores[2]["observed_cells"], 0);
}

TEST_F(ServiceFix, AFrameOverRoadDataIsReadAsAFeatureMapToBeComparedWithRoads) {
  if (default_model(SourceContent::kImagery) == default_model(SourceContent::kRoads)) {
    GTEST_SKIP() << "models/roadnet*.onnx are not both there";
  }
  const testing::ServiceProcess neural(folder->path(), {"--detector", "neural"});
  httplib::Client client = testing::client_of(neural);
  cv::Mat frame(400, 400, CV_8UC3);
  cv::randu(frame, 0, 255);
  cv::GaussianBlur(frame, frame, {}, 4.0);
  std::vector<std::uint8_t> png;
  cv::imencode(".png", frame, png);
  const json poses = {{{"lat", town->place.lat_deg}, {"lon", town->place.lon_deg}, {"heading_deg", 20.0}}};
  const auto rho_of = [&](json request) {
    request["poses"] = poses;
    return testing::json_of(client.Post("/v1/maps/town/match", request.dump(), "application/json"))["scores"][0]["rho"]
        .get<double>();
  };
  const auto features = [&](const std::string& compared) {
    return testing::json_of(
        client.Post("/v1/detect?gsd_m=1&format=json" + compared, testing::text_of(png), "image/png"));
  };
  const json for_roads = features("&compare_with=roads");
  const json for_imagery = features("&compare_with=imagery");
  EXPECT_EQ(features("")["cells"], for_imagery["cells"]);
  EXPECT_NE(for_roads["made_by"]["detector"], for_imagery["made_by"]["detector"]);
  const double of_frame = rho_of({{"image", api::base64_encoded(png)}, {"kind", "frame"}, {"gsd_m", 1.0}});
  EXPECT_EQ(of_frame, rho_of(for_roads));
  EXPECT_NE(of_frame, rho_of(for_imagery));
  EXPECT_EQ(testing::refusal(client.Post("/v1/detect?gsd_m=1&compare_with=x", testing::text_of(png), "image/png")),
            "400 bad-parameter compare_with");
}

TEST_F(ServiceFix, TurnsFramesIntoFeatureMapsAndFixes) {
  cv::Mat frame(300, 400, CV_8UC3, cv::Scalar(90, 110, 100));
  std::vector<std::uint8_t> png;
  cv::imencode(".png", frame, png);
  const auto picture = client_.Post("/v1/detect?gsd_m=0.5&cell_m=2", testing::text_of(png), "image/png");
  ASSERT_EQ(picture->status, 200) << picture->body;
  EXPECT_EQ(picture->get_header_value("Content-Type"), "image/png");
  const json features = testing::json_of(client_.Post(
      "/v1/detect?fov_deg=60&agl_m=200&roll_deg=0&pitch_deg=10&format=json", testing::text_of(png), "image/png"));
  EXPECT_GT(features["cols"], 50);
  EXPECT_NEAR(features["nadir_sigma_m"], 4.01, 0.01) << "a degree at 200 m, and 5 % of 35 m";
  const auto known_to = [&](const std::string& sigma_deg) {
    const std::string query = "fov_deg=60&agl_m=200&roll_deg=0&pitch_deg=10&attitude_sigma_deg=" + sigma_deg;
    return client_.Post("/v1/detect?format=json&" + query, testing::text_of(png), "image/png");
  };
  EXPECT_NEAR(testing::json_of(known_to("2"))["nadir_sigma_m"], 7.41, 0.01) << "two degrees, and 5 % of 35 m";
  EXPECT_EQ(testing::refusal(known_to("0")), "400 parameter-out-of-range attitude_sigma_deg");
  json posted_back = features;
  const auto located = client_.Post("/v1/maps/town/fix", posted_back.dump(), "application/json");
  EXPECT_EQ(located->status, 200) << located->body;
  posted_back["poses"] = {{{"lat", 0}, {"lon", 0}, {"heading_deg", 0}}};
  const auto matched = client_.Post("/v1/maps/town/match", posted_back.dump(), "application/json");
  EXPECT_EQ(matched->status, 200) << matched->body;
  const std::string focal = "/v1/detect?focal_px=200&agl_m=100&format=json";
  const auto cols = [&](const std::string& lens) {
    return testing::json_of(client_.Post(focal + lens, testing::text_of(png), "image/png"))["cols"].get<int>();
  };
  EXPECT_EQ(cols("&principal_px=199.5,149.5"), 100);
  EXPECT_GT(cols("&distortion=-0.1,0,0,0"), 105) << "its edges see farther";
  EXPECT_GT(cols("&lens=fisheye&distortion=0,0,0,0"), 150);
  const auto jpeg =
      testing::drone_jpeg(frame, R"(drone-dji:CalibratedFocalLength="200" drone-dji:RelativeAltitude="+100")");
  const auto fix_of_photo = [&](const std::string& attitude) {
    const std::string path = "/v1/maps/town/fix?kind=frame&exif=true" + attitude;
    return testing::json_of(client_.Post(path, testing::text_of(jpeg), "image/jpeg"));
  };
  EXPECT_EQ(fix_of_photo("")["code"], "camera-not-in-file") << "where did it look?";
  const json of_drone = fix_of_photo("&roll_deg=0&pitch_deg=0");
  EXPECT_EQ(of_drone["camera"]["agl_m"], 100.0) << of_drone;
  EXPECT_EQ(of_drone["camera"]["focal_px"], 200.0);
  const json fix =
      testing::json_of(client_.Post("/v1/maps/town/fix?kind=frame&gsd_m=0.5", testing::text_of(png), "image/png"));
  EXPECT_EQ(fix["status"], "no_fix") << "a bare field shows no road";
  EXPECT_FALSE(fix.contains("pose"));
}

}  // namespace
}  // namespace roadfix
