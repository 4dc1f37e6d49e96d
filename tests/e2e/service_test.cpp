// The service as a client meets it: the real program over real sockets.
#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <regex>

#include "tests/e2e/served_town.hpp"
#include "tests/e2e/tile_at.hpp"
#include "tiles/mercator/web_mercator.hpp"

namespace roadfix {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class Service : public testing::ServedTown {};

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

TEST_F(Service, ServesTilesThatClientsMayCache) {
  const auto tilejson = client_.Get("/v1/maps/town/tilejson.json");
  EXPECT_EQ(tilejson->get_header_value("Cache-Control"), "no-cache") << "it tells the tiles of the map as it is now";
  const json description = testing::json_of(tilejson);
  EXPECT_EQ(description["attribution"], "CC0");
  EXPECT_THAT(description["tiles"][0].get<std::string>(), HasSubstr("/v1/maps/town/tiles/{z}/{x}/{y}.png?version="));
  const std::string path = "/v1/maps/town/tiles/" + testing::tile_at(town->place);
  const auto tile = client_.Get(path);
  ASSERT_EQ(tile->status, 200);
  EXPECT_EQ(tile->get_header_value("Content-Type"), "image/png");
  EXPECT_THAT(tile->get_header_value("Cache-Control"), HasSubstr("max-age"));
  const auto again = client_.Get(path, {{"If-None-Match", tile->get_header_value("ETag")}});
  EXPECT_EQ(again->status, 304);
  EXPECT_TRUE(again->body.empty());
  EXPECT_NE(client_.Get(path + "?style=grey")->get_header_value("ETag"), tile->get_header_value("ETag"));
  EXPECT_EQ(client_.Get(path + "?version=7f3a")->get_header_value("ETag"), tile->get_header_value("ETag"));
  EXPECT_EQ(client_.Get("/v1/maps/town/tiles/16/0/0.png")->status, 204);
  EXPECT_EQ(testing::refusal(client_.Get("/v1/maps/town/tiles/16/70000/0.png")), "404 tile-not-found");
}

TEST_F(Service, CreditsTheMapInEveryFormatOfAWindow) {
  const std::string window =
      "/v1/maps/town/window?width_m=100&height_m=100&lat=" + std::to_string(town->place.lat_deg) +
      "&lon=" + std::to_string(town->place.lon_deg);
  EXPECT_EQ(testing::json_of(client_.Get(window + "&format=json"))["attribution"], "CC0");
  EXPECT_THAT(client_.Get(window + "&format=png")->body, HasSubstr(std::string("iTXtCopyright\0\0\0\0\0CC0", 21)));
  EXPECT_THAT(client_.Get(window + "&format=tiff")->body,
              ::testing::AllOf(HasSubstr("CC0"), HasSubstr("Probability of road, by Roadfix")));
}

TEST_F(Service, ServesWhatPlacesPromiseAsTiles) {
  const json description = testing::json_of(client_.Get("/v1/maps/town/localizability/tilejson.json?footprint_m=500"));
  EXPECT_EQ(description["attribution"], "CC0");
  EXPECT_THAT(description["tiles"][0].get<std::string>(),
              ::testing::AllOf(HasSubstr("/v1/maps/town/localizability/tiles/{z}/{x}/{y}.png?version="),
                               ::testing::EndsWith("&footprint_m=500")));
  EXPECT_LT(description["minzoom"], description["maxzoom"]);
  const auto path = [&](int zoom, const std::string& query) {
    const mercator::MercatorPixel pixel = mercator::mercator_pixel(town->place, zoom);
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
  const auto coloured = client_.Get(path(19, "?footprint_m=500"));
  const std::vector<std::uint8_t> coloured_png(coloured->body.begin(), coloured->body.end());
  const cv::Mat colours = cv::imdecode(coloured_png, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(colours.size(), picture.size());
  for (int i = 0; i < 256; ++i) {
    const bool is_green = colours.at<cv::Vec4b>(i, i) == cv::Vec4b(161, 224, 126, 128);
    const int grey = picture.at<cv::Vec4b>(i, i)[0];
    if (grey != 252) {
      EXPECT_EQ(is_green, grey > 252) << "the confidence is 0.99, and 252 is on both sides of it";
    }
  }
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
  const auto plain = client_.Get("/openapi.json", {{"Accept-Encoding", "identity"}});
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
  EXPECT_THAT(text, HasSubstr("roadfix_tracks 0\n"));
  EXPECT_THAT(text, HasSubstr("roadfix_track_streams 0\n"));
  const std::string nothing = testing::text_of(encode_feature_map(CellArray(64, 64, kNoRoad)));
  EXPECT_EQ(testing::json_of(client_.Post("/v1/maps/town/fix?cell_m=2", nothing, "image/png"))["status"], "no_fix");
  EXPECT_THAT(client_.Get("/metrics")->body, HasSubstr("roadfix_answers_total{kind=\"fix\",status=\"no_fix\"}"));
  EXPECT_FALSE(testing::json_of(client_.Get("/healthz"))["version"].get<std::string>().empty());
}

TEST_F(Service, TellsHowLargeItsCachesAre) {
  client_.Post("/v1/maps/town/fix?cell_m=2", town->seen(), "image/png");
  client_.Get("/v1/maps/town/tiles/" + testing::tile_at(town->place));
  const std::string filled = client_.Get("/metrics")->body;
  for (const char* cache : {"map", "search", "picture"}) {
    EXPECT_THAT(filled, ContainsRegex("roadfix_" + std::string(cache) + "_cache_bytes [1-9]"));
  }
}

}  // namespace
}  // namespace roadfix
