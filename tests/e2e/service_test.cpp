// The service as a client meets it: the real program over real sockets.
#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <regex>

#include "server/api/base64.hpp"
#include "server/api/web_mercator.hpp"
#include "tests/e2e/service_fixture.hpp"

namespace roadfix {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Service : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    town = new testing::Town;
    folder = new testing::TemporaryFolder;
    testing::write_map_file(*folder / "town.gpkg", town->roads, 2.0);
    service = new testing::ServiceProcess(folder->path(), {"--cors-origin", "*", "--request-time", "600"});
  }
  static void TearDownTestSuite() {
    delete service;
    delete folder;
    delete town;
  }

  static std::string place(double radius_m = 300.0) {
    return "&lat=" + std::to_string(town->place.lat_deg) + "&lon=" + std::to_string(town->place.lon_deg) +
           "&radius_m=" + std::to_string(radius_m);
  }
  static std::string window_query(double heading_deg) {
    return "/v1/maps/town/window?lat=" + std::to_string(town->place.lat_deg) +
           "&lon=" + std::to_string(town->place.lon_deg) +
           "&width_m=320&height_m=320&heading_deg=" + std::to_string(heading_deg);
  }
  static void expect_pose(const json& pose, LatLon at, double heading_deg, double metres, double degrees) {
    const GridPoint truth = town->zone.project(at);
    EXPECT_LT(distance_m(town->zone.project({pose["lat"], pose["lon"]}), truth), metres);
    EXPECT_LT(angular_distance(Angle::degrees(pose["heading_deg"]), Angle::degrees(heading_deg)).degrees(), degrees);
  }

  inline static testing::Town* town = nullptr;
  inline static testing::TemporaryFolder* folder = nullptr;
  inline static testing::ServiceProcess* service = nullptr;
  httplib::Client client_ = testing::client_of(*service);
};

TEST_F(Service, GivesTheBrowserAPageThatLoadsNothingFromElsewhere) {
  const auto page = client_.Get("/");
  EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_THAT(page->get_header_value("Content-Security-Policy"), HasSubstr("default-src 'self'"));
  const std::regex part(R"re((?:src|href)="(/console/[^"]+)")re");
  int parts = 0;
  for (auto it = std::sregex_iterator(page->body.begin(), page->body.end(), part); it != std::sregex_iterator(); ++it) {
    const auto file = client_.Get((*it)[1].str());
    EXPECT_EQ(file->status, 200) << (*it)[1];
    EXPECT_GT(file->body.size(), 100U) << (*it)[1];
    const httplib::Headers known{{"If-None-Match", file->get_header_value("ETag")}};
    EXPECT_EQ(client_.Get((*it)[1].str(), known)->status, 304) << (*it)[1];
    ++parts;
  }
  EXPECT_EQ(parts, 4);
  EXPECT_EQ(client_.Get("/console/passwd")->status, 404);
}

TEST_F(Service, SaysThatItLivesAndWhatItServes) {
  EXPECT_EQ(client_.Get("/healthz")->status, 200);
  EXPECT_EQ(testing::json_of(client_.Get("/readyz"))["maps"], 1);
  EXPECT_EQ(testing::json_of(client_.Get("/readyz"))["tracks"], "ready");
  const json list = testing::json_of(client_.Get("/v1/maps"));
  ASSERT_EQ(list["maps"].size(), 1U);
  EXPECT_EQ(list["maps"][0]["status"], "ready");
  const json map = testing::json_of(client_.Get("/v1/maps/town"));
  EXPECT_EQ(map["epsg"], 32634);
  EXPECT_EQ(map["sources"][0]["name"], "town");
  EXPECT_EQ(testing::json_of(client_.Get("/openapi.json"))["openapi"], "3.1.0");
  EXPECT_GT(testing::json_of(client_.Get("/v1/limits"))["poses"], 0);
}

TEST_F(Service, ReturnsThePoseOfAWindowThatIsPostedBackAsItIs) {
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

TEST_F(Service, FixesAFeatureMapFromEveryKindOfBody) {
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

TEST_F(Service, GivesAFixInTheWordsOfAutopilots) {
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

TEST_F(Service, LaysFramesOfAFlightTogether) {
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

  const auto refusal = [&](const json& also) {
    request["also"] = also;
    return testing::refusal(client_.Post("/v1/maps/town/fix", request.dump(), "application/json"));
  };
  EXPECT_EQ(refusal(7), "400 bad-parameter also");
  EXPECT_EQ(refusal(json::array({frame, 7})), "400 bad-parameter also[1]");
  EXPECT_EQ(refusal(json(std::vector<json>(16, frame))), "422 too-many-frames");
  json bent = frame;
  bent["turn_deg"] = "left";
  EXPECT_EQ(refusal(json::array({bent})), "400 bad-parameter also[0].turn_deg");
  bent = frame;
  bent["image"] = "!";
  EXPECT_EQ(refusal(json::array({bent})), "400 bad-base64 also[0].image");
  bent = frame;
  bent["right_m"] = bent["forward_m"] = 9e4;
  EXPECT_EQ(refusal(json::array({bent})), "422 frames-too-far-apart");
}

TEST_F(Service, SearchesOnlyWhereThePriorAllows) {
  const std::string seen = town->seen();
  const json near = testing::json_of(client_.Post(
      "/v1/maps/town/fix?cell_m=2&heading_range_deg=20&heading_deg=" + std::to_string(town->heading_deg) + place(100),
      seen, "image/png"));
  EXPECT_EQ(near["status"], "fix") << near;
  EXPECT_LT(near["searched"]["area_km2"], 0.05);
  EXPECT_EQ(testing::refusal(client_.Post("/v1/maps/town/fix?cell_m=2&lat=10&lon=20&radius_m=50", seen, "image/png")),
            "422 prior-outside-map");
}

TEST_F(Service, FixesWhatWasSeenFromAnAltitudeKnownRoughly) {
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

TEST_F(Service, SaysWhatItHasWhereTheTimeLimitEndsTheSearch) {
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

TEST_F(Service, SaysBeforeTheFlightWhatAFrameOfAPlaceWouldGive) {
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

TEST_F(Service, ScoresPosesInTheirOrder) {
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

TEST_F(Service, TurnsFramesIntoFeatureMapsAndFixes) {
  cv::Mat frame(300, 400, CV_8UC3, cv::Scalar(90, 110, 100));
  std::vector<std::uint8_t> png;
  cv::imencode(".png", frame, png);
  const auto picture = client_.Post("/v1/detect?gsd_m=0.5&cell_m=2", testing::text_of(png), "image/png");
  ASSERT_EQ(picture->status, 200) << picture->body;
  EXPECT_EQ(picture->get_header_value("Content-Type"), "image/png");
  const json features = testing::json_of(
      client_.Post("/v1/detect?fov_deg=60&agl_m=200&pitch_deg=10&format=json", testing::text_of(png), "image/png"));
  EXPECT_GT(features["cols"], 50);
  const json fix =
      testing::json_of(client_.Post("/v1/maps/town/fix?kind=frame&gsd_m=0.5", testing::text_of(png), "image/png"));
  EXPECT_EQ(fix["status"], "no_fix") << "a bare field shows no road";
  EXPECT_FALSE(fix.contains("pose"));
}

TEST_F(Service, ServesTilesThatClientsMayCache) {
  const json description = testing::json_of(client_.Get("/v1/maps/town/tilejson.json"));
  EXPECT_THAT(description["tiles"][0].get<std::string>(), HasSubstr("/v1/maps/town/tiles/{z}/{x}/{y}.png"));
  const api::MercatorPixel pixel = api::mercator_pixel(town->place, 16);
  const std::string path = "/v1/maps/town/tiles/16/" + std::to_string(static_cast<int>(pixel.x / 256)) + "/" +
                           std::to_string(static_cast<int>(pixel.y / 256)) + ".png";
  const auto tile = client_.Get(path);
  ASSERT_EQ(tile->status, 200);
  EXPECT_EQ(tile->get_header_value("Content-Type"), "image/png");
  EXPECT_THAT(tile->get_header_value("Cache-Control"), HasSubstr("max-age"));
  const auto again = client_.Get(path, {{"If-None-Match", tile->get_header_value("ETag")}});
  EXPECT_EQ(again->status, 304);
  EXPECT_TRUE(again->body.empty());
  EXPECT_NE(client_.Get(path + "?style=grey")->get_header_value("ETag"), tile->get_header_value("ETag"));
  EXPECT_EQ(client_.Get("/v1/maps/town/tiles/16/0/0.png")->status, 204);
  EXPECT_EQ(testing::refusal(client_.Get("/v1/maps/town/tiles/16/70000/0.png")), "404 tile-not-found");
}

TEST_F(Service, ServesWhatPlacesPromiseAsTiles) {
  const json description = testing::json_of(client_.Get("/v1/maps/town/localizability/tilejson.json?footprint_m=500"));
  EXPECT_THAT(description["tiles"][0].get<std::string>(),
              HasSubstr("/v1/maps/town/localizability/tiles/{z}/{x}/{y}.png?footprint_m=500"));
  EXPECT_LT(description["minzoom"], description["maxzoom"]);
  const auto path = [&](int zoom, const std::string& query) {
    const api::MercatorPixel pixel = api::mercator_pixel(town->place, zoom);
    return "/v1/maps/town/localizability/tiles/" + std::to_string(zoom) + "/" +
           std::to_string(static_cast<int>(pixel.x / 256)) + "/" + std::to_string(static_cast<int>(pixel.y / 256)) +
           ".png" + query;
  };
  // A slow machine may need several requests; each goes on where the one before it ended.
  auto tile = client_.Get(path(19, "?footprint_m=500&style=grey"));
  for (int i = 0; i < 20 && tile->status == 503; ++i) tile = client_.Get(path(19, "?footprint_m=500&style=grey"));
  ASSERT_EQ(tile->status, 200) << tile->body;
  EXPECT_EQ(tile->get_header_value("Content-Type"), "image/png");
  const std::vector<std::uint8_t> png(tile->body.begin(), tile->body.end());
  const cv::Mat picture = cv::imdecode(png, cv::IMREAD_UNCHANGED);
  EXPECT_EQ(picture.size(), cv::Size(256, 256));
  EXPECT_EQ(cv::mean(picture)[3], 255.0) << "all of it is on the map";
  const httplib::Headers known{{"If-None-Match", tile->get_header_value("ETag")}};
  EXPECT_EQ(client_.Get(path(19, "?footprint_m=500&style=grey"), known)->status, 304);
  EXPECT_EQ(client_.Get(path(10, "?footprint_m=500"))->status, 204) << "one place does not speak for a province";
  EXPECT_EQ(client_.Get("/v1/maps/town/localizability/tiles/16/0/0.png")->status, 204);
  EXPECT_EQ(testing::refusal(client_.Get(path(19, "?footprint_m=3"))), "400 parameter-out-of-range footprint_m");
}

TEST_F(Service, GivesWindowsAsGeoTiffToo) {
  const auto tiff = client_.Get(window_query(20.0), {{"Accept", "image/tiff"}});
  EXPECT_EQ(tiff->get_header_value("Content-Type"), "image/tiff");
  EXPECT_THAT(tiff->body.substr(0, 4), ::testing::AnyOf(std::string("II*\0", 4), std::string("MM\0*", 4)));
  EXPECT_EQ(testing::refusal(client_.Get(window_query(20.0), {{"Accept", "text/html"}})), "406 not-acceptable");
}

TEST_F(Service, PacksJsonWithGzipAndTellsCachesSo) {
  const auto plain = client_.Get("/openapi.json");
  EXPECT_FALSE(plain->has_header("Content-Encoding"));
  const auto packed = client_.Get("/openapi.json", {{"Accept-Encoding", "gzip, br"}});
  EXPECT_EQ(packed->get_header_value("Content-Encoding"), "gzip");
  EXPECT_THAT(packed->get_header_value("Vary"), HasSubstr("Accept-Encoding"));
}

TEST_F(Service, EchoesTheRequestIdAndMakesOneUp) {
  EXPECT_EQ(client_.Get("/healthz", {{"X-Request-Id", "flight-7"}})->get_header_value("X-Request-Id"), "flight-7");
  EXPECT_FALSE(client_.Get("/healthz")->get_header_value("X-Request-Id").empty());
  EXPECT_NE(client_.Get("/healthz", {{"X-Request-Id", std::string(500, 'x')}})->get_header_value("X-Request-Id"),
            std::string(500, 'x'));
}

TEST_F(Service, AnswersBrowsersOfOtherOrigins) {
  EXPECT_EQ(client_.Get("/healthz")->get_header_value("Access-Control-Allow-Origin"), "*");
  EXPECT_EQ(client_.Get("/healthz")->get_header_value("Access-Control-Expose-Headers"), "*");
  const auto preflight = client_.Options("/v1/maps/town/fix");
  EXPECT_EQ(preflight->status, 204);
  EXPECT_EQ(preflight->get_header_value("Allow"), "OPTIONS, POST");
  EXPECT_EQ(preflight->get_header_value("Access-Control-Max-Age"), "600");
  EXPECT_THAT(preflight->get_header_value("Access-Control-Allow-Headers"), HasSubstr("Authorization"));
}

TEST_F(Service, CountsWhatItDoes) {
  client_.Get("/v1/maps/town");
  const std::string text = client_.Get("/metrics")->body;
  EXPECT_THAT(text, HasSubstr("roadfix_requests_total{method=\"GET\",route=\"/v1/maps/{map}\",status=\"200\"}"));
  EXPECT_THAT(text, HasSubstr("roadfix_maps 1\n"));
  EXPECT_THAT(text, HasSubstr("roadfix_tracks_available 1\n"));
  const std::string nothing = testing::text_of(encode_feature_map(CellArray(64, 64, kNoRoad)));
  EXPECT_EQ(testing::json_of(client_.Post("/v1/maps/town/fix?cell_m=2", nothing, "image/png"))["status"], "no_fix");
  EXPECT_THAT(client_.Get("/metrics")->body, HasSubstr("roadfix_answers_total{kind=\"fix\",status=\"no_fix\"}"));
  EXPECT_FALSE(testing::json_of(client_.Get("/healthz"))["version"].get<std::string>().empty());
}

}  // namespace
}  // namespace roadfix
