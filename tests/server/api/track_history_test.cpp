#include "server/api/track_history.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace roadfix::api {
namespace {

const FlownTrack kTrack{"5f1c", {"a&b<c>\x01\xff", "7f3a"}};

std::string answer_at(double lon_deg, int sequence = 1, std::int64_t time_us = 1) {
  return nlohmann::json{{"sequence", sequence},
                        {"time_us", time_us},
                        {"status", "converged"},
                        {"geometry", {{"type", "Point"}, {"coordinates", {lon_deg, -17.0}}}},
                        {"pose", {{"lat", -17.0}, {"lon", lon_deg}, {"heading_deg", 90.0}}},
                        {"sigma_m", {1.0, 1.0}},
                        {"ellipse_heading_deg", 0.0},
                        {"heading_sigma_deg", 1.0}}
      .dump();
}

nlohmann::json line_of(const std::vector<std::string>& answers) {
  return history_json(kTrack, answers)["features"].back()["geometry"];
}

TEST(TrackHistory, SaysOfEachStepHowItWasToldAndByWhat) {
  const nlohmann::json properties{{"sequence", 7},
                                  {"time_us", 8},
                                  {"status", "searching"},
                                  {"reason", "several-places"},
                                  {"doubt", 0.2},
                                  {"drifts", false},
                                  {"measurement", "rejected"},
                                  {"resets", 1},
                                  {"made_by", {{"roadfix", "0.1.0"}}}};
  nlohmann::json answer = properties;
  answer["clusters"] = nlohmann::json::array();
  const nlohmann::json history = history_json(kTrack, std::vector<std::string>{answer.dump()});
  EXPECT_EQ(history["features"][0]["properties"], properties);
}

TEST(TrackHistory, DrawsNoLineThroughStepsAtWhichNothingWasClaimed) {
  const std::string lost = R"({"sequence": 2, "time_us": 2, "status": "searching"})";
  EXPECT_EQ(line_of({answer_at(10), answer_at(11), lost, lost, answer_at(14), answer_at(15), lost, answer_at(17)}),
            nlohmann::json::parse(R"({"type": "MultiLineString",
                "coordinates": [[[10.0, -17.0], [11.0, -17.0]], [[14.0, -17.0], [15.0, -17.0]]]})"));
  EXPECT_EQ(line_of({lost, answer_at(10), lost, answer_at(11), answer_at(12)})["type"], "LineString");
  EXPECT_EQ(line_of({answer_at(10), lost, answer_at(11)})["type"], "Point") << "no two in a row";
}

TEST(TrackHistory, EndsWithTheFlightAsALineThatIsCutAt180Degrees) {
  EXPECT_EQ(line_of({answer_at(178.5), answer_at(179.5)}),
            nlohmann::json::parse(R"({"type": "LineString", "coordinates": [[178.5, -17.0], [179.5, -17.0]]})"));
  EXPECT_EQ(line_of({answer_at(179.5), answer_at(-179.5)}), nlohmann::json::parse(R"({"type": "MultiLineString",
      "coordinates": [[[179.5, -17.0], [180.0, -17.0]], [[-180.0, -17.0], [-179.5, -17.0]]]})"));
}

constexpr std::int64_t kDateUs = 1'700'000'000'123'999;

std::vector<std::string> interrupted_flight() {
  const std::string lost = R"({"sequence": 9, "time_us": 2, "status": "searching"})";
  return {lost,
          answer_at(179.5, 1, kDateUs),
          answer_at(-179.5, 2, kDateUs + 60'000'000),
          lost,
          lost,
          answer_at(180.0, 5, 7'000'000),
          lost};
}

TEST(TrackHistory, TellsTheDateOfAStepBesideItsMicroseconds) {
  const nlohmann::json history = history_json(kTrack, interrupted_flight());
  EXPECT_EQ(history["features"][1]["properties"]["time"], "2023-11-14T22:13:20.123Z");
  EXPECT_EQ(history["features"][2]["properties"]["time"], "2023-11-14T22:14:20.123Z");
  EXPECT_FALSE(history["features"][5]["properties"].contains("time")) << "a clock that counts from its start";
}

TEST(TrackHistory, AsGpxHasASegmentForEachRunOfClaims) {
  EXPECT_EQ(history_gpx(kTrack, interrupted_flight()), R"(<?xml version="1.0" encoding="UTF-8"?>
<gpx version="1.1" creator="roadfix 0.1.0" xmlns="http://www.topografix.com/GPX/1/1">
<trk>
<name>Track 5f1c</name>
<desc>Where roadfix 0.1.0 found the UAV on the map a&amp;b&lt;c&gt;?�, version 7f3a. WGS 84, without heights</desc>
<trkseg>
<trkpt lat="-17.0000000" lon="179.5000000"><time>2023-11-14T22:13:20.123Z</time><cmt>heading 90.0 degrees true, 1 sigma 1.0 x 1.0 m</cmt></trkpt>
<trkpt lat="-17.0000000" lon="-179.5000000"><time>2023-11-14T22:14:20.123Z</time><cmt>heading 90.0 degrees true, 1 sigma 1.0 x 1.0 m</cmt></trkpt>
</trkseg>
<trkseg>
<trkpt lat="-17.0000000" lon="-180.0000000"><cmt>heading 90.0 degrees true, 1 sigma 1.0 x 1.0 m</cmt></trkpt>
</trkseg>
</trk>
</gpx>
)");
}

TEST(TrackHistory, AsKmlHasALineForEachRunOfClaimsAndAPointForEach) {
  EXPECT_EQ(history_kml(kTrack, interrupted_flight()), R"(<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2">
<Document>
<name>Track 5f1c</name>
<description>Where roadfix 0.1.0 found the UAV on the map a&amp;b&lt;c&gt;?�, version 7f3a. WGS 84, without heights</description>
<Style id="step"><IconStyle><scale>0.4</scale></IconStyle><LabelStyle><scale>0</scale></LabelStyle></Style>
<Placemark><name>Flight</name>
<MultiGeometry>
<LineString><tessellate>1</tessellate><coordinates>179.5000000,-17.0000000 180.0000000,-17.0000000</coordinates></LineString>
<LineString><tessellate>1</tessellate><coordinates>-180.0000000,-17.0000000 -179.5000000,-17.0000000</coordinates></LineString>
</MultiGeometry>
</Placemark>
<Folder><name>Steps</name>
<Placemark><name>1</name><description>heading 90.0 degrees true, 1 sigma 1.0 x 1.0 m</description><TimeStamp><when>2023-11-14T22:13:20.123Z</when></TimeStamp><styleUrl>#step</styleUrl><Point><coordinates>179.5000000,-17.0000000</coordinates></Point></Placemark>
<Placemark><name>2</name><description>heading 90.0 degrees true, 1 sigma 1.0 x 1.0 m</description><TimeStamp><when>2023-11-14T22:14:20.123Z</when></TimeStamp><styleUrl>#step</styleUrl><Point><coordinates>-179.5000000,-17.0000000</coordinates></Point></Placemark>
<Placemark><name>5</name><description>heading 90.0 degrees true, 1 sigma 1.0 x 1.0 m</description><styleUrl>#step</styleUrl><Point><coordinates>180.0000000,-17.0000000</coordinates></Point></Placemark>
</Folder>
</Document>
</kml>
)");
}

TEST(TrackHistory, OfATrackThatClaimedNothingIsAnEmptyFlight) {
  const std::vector<std::string> nothing;
  EXPECT_EQ(history_gpx(kTrack, nothing).find("<trkseg>"), std::string::npos);
  EXPECT_EQ(history_kml(kTrack, nothing).find("<Placemark>"), std::string::npos);
  EXPECT_EQ(history_json(kTrack, nothing)["features"], nlohmann::json::array());
}

}  // namespace
}  // namespace roadfix::api
