#include "core/routes/route.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::routes {
namespace {

using ::testing::AllOf;
using testing::code_of;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using ::testing::SizeIs;

auto place(double lat_deg, double lon_deg) {
  return Field(&RoutePlace::position,
               AllOf(Field(&LatLon::lat_deg, DoubleEq(lat_deg)), Field(&LatLon::lon_deg, DoubleEq(lon_deg))));
}

using Height = std::optional<PlannedHeight>;

std::vector<Height> heights_of(const Route& route) {
  std::vector<Height> heights;
  for (const RoutePlace& place : route.places) heights.push_back(place.height);
  return heights;
}

Height above_sea(double metres) { return PlannedHeight{metres, HeightAbove::kSea}; }
Height above_home(double metres) { return PlannedHeight{metres, HeightAbove::kHome}; }
Height above_ground(double metres) { return PlannedHeight{metres, HeightAbove::kGround}; }

std::string simple_item(int command, const std::string& lat, const std::string& lon, int frame = 3,
                        const std::string& height = "50") {
  return R"({"type":"SimpleItem","autoContinue":true,"frame":)" + std::to_string(frame) +
         R"(,"doJumpId":1,"command":)" + std::to_string(command) + R"(,"params":[0,0,0,null,)" + lat + "," + lon + "," +
         height + "]}";
}

std::string plan(const std::string& items, const std::string& home = "[47.39,8.54,488]") {
  return R"({"fileType":"Plan","version":1,"groundStation":"QGroundControl","geoFence":{},"rallyPoints":{},"mission":{)"
         R"("version":2,"plannedHomePosition":)" +
         home + R"(,"items":[)" + items + "]}}";
}

TEST(Routes, OfAPlanLeadFromTheHomeOverWhatIsFlownToAndBackWhereItReturns) {
  const std::string items = simple_item(22, "47.391", "8.541") + "," +  // take-off
                            simple_item(206, "47.0", "8.0") + "," +     // camera trigger
                            simple_item(16, "47.392", "8.542") + "," +  // waypoint
                            simple_item(195, "46.0", "7.0") + "," +     // a region of interest is looked at
                            simple_item(82, "47.393", "8.543") + "," +  // spline
                            simple_item(17, "null", "null") + "," +     // loiters where it is
                            simple_item(21, "0", "0") + "," +           // lands where it is
                            simple_item(20, "0", "0");                  // return to launch
  const Route route = parse_route(plan(items));
  EXPECT_THAT(route.places, ElementsAre(place(47.39, 8.54), place(47.391, 8.541), place(47.392, 8.542),
                                        place(47.393, 8.543), place(47.39, 8.54)));
  EXPECT_THAT(route.left_out, IsEmpty());
}

TEST(Routes, OfAPlanWithoutAHomeBeginAtItsFirstPlace) {
  const std::string items =
      simple_item(16, "47.1", "8.1") + "," + simple_item(16, "47.2", "8.2") + "," + simple_item(20, "0", "0");
  EXPECT_THAT(parse_route(plan(items, "[0,0,0]")).places, ElementsAre(place(47.1, 8.1), place(47.2, 8.2)));
}

TEST(Routes, OfAPlanWhoseHomeIsNotSetBeginAtItsFirstPlace) {
  const std::string items = simple_item(22, "47.1", "8.1") + "," + simple_item(16, "47.2", "8.2");
  for (const char* home : {"null", "[null,null,null]"}) {
    const Route route = parse_route(plan(items, home));
    EXPECT_THAT(route.places, ElementsAre(place(47.1, 8.1), place(47.2, 8.2))) << home;
    EXPECT_THAT(heights_of(route), ElementsAre(above_home(50), above_home(50))) << home;
  }
}

TEST(Routes, FlyOnceWhatAPlanRepeatsAndSaySo) {
  const std::string jump = R"({"type":"SimpleItem","command":177,"frame":2,"params":[2,3,0,0,0,0,0]})";
  const Route of_a_plan =
      parse_route(plan(simple_item(16, "47.1", "8.1") + "," + simple_item(16, "47.2", "8.2") + "," + jump));
  EXPECT_THAT(of_a_plan.places, ElementsAre(place(47.39, 8.54), place(47.1, 8.1), place(47.2, 8.2)));
  EXPECT_THAT(of_a_plan.left_out, ElementsAre(HasSubstr("item 3, a jump")));
  const Route of_a_list = parse_route(
      "QGC WPL 110\n"
      "0 1 0 16 0 0 0 0 47.1 8.1 550 1\n"
      "1 0 3 16 0 0 0 0 47.2 8.2 100 1\n"
      "2 0 3 177 1 -1 0 0 0 0 0 1\n");
  EXPECT_THAT(of_a_list.places, SizeIs(2));
  EXPECT_THAT(of_a_list.left_out, ElementsAre(HasSubstr("line 4, a jump")));
}

TEST(Routes, OfAPlanFollowTheTransectsOfSurveysAndTheApproachOfLandings) {
  const std::string survey = R"({"type":"ComplexItem","complexItemType":"survey","polygon":[[47,8],[47,9],[48,9]],)"
                             R"("TransectStyleComplexItem":{"Items":[)" +
                             simple_item(16, "47.1", "8.1") + "," + simple_item(16, "47.1", "8.2") + R"(]}})";
  const std::string landing =
      R"({"type":"ComplexItem","complexItemType":"fwLandingPattern","landingApproachCoordinate":[47.3,8.3,40],)"
      R"("landCoordinate":[47.4,8.4,0]})";
  EXPECT_THAT(parse_route(plan(survey + "," + landing)).places,
              ElementsAre(place(47.39, 8.54), place(47.1, 8.1), place(47.1, 8.2), place(47.3, 8.3), place(47.4, 8.4)));
}

TEST(Routes, OfAnOldPlanLoiterDownBeforeALandingEachPlaceAtAHeightOfItsOwnKind) {
  const Route route = parse_route(
      plan(R"({"type":"ComplexItem","complexItemType":"fwLandingPattern","version":1,"loiterCoordinate":[47.3,8.3,40],)"
           R"("loiterAltitudeRelative":true,"landCoordinate":[47.4,8.4,480],"landingAltitudeRelative":false})"));
  EXPECT_THAT(route.places, ElementsAre(place(47.39, 8.54), place(47.3, 8.3), place(47.4, 8.4)));
  EXPECT_THAT(heights_of(route), ElementsAre(above_home(0), above_home(40), above_sea(480)));
}

TEST(Routes, OfAPlanNameWhatTheyLeaveOut) {
  const std::string scan = R"({"type":"ComplexItem","complexItemType":"StructureScan","polygon":[[47,8],[47,9]]})";
  const std::string untouched =
      R"({"type":"ComplexItem","complexItemType":"survey","TransectStyleComplexItem":{"Items":[]}})";
  const Route route = parse_route(plan(simple_item(16, "47.1", "8.1") + "," + scan + "," + untouched));
  EXPECT_THAT(route.places, SizeIs(2));
  EXPECT_THAT(route.left_out, ElementsAre(HasSubstr("item 2, a StructureScan"), HasSubstr("item 3, a survey")));
}

TEST(Routes, OfAPlanAreAsHighAsEachItemCountsItAndReturnAsHighAsTheyAre) {
  const std::string survey = R"({"type":"ComplexItem","complexItemType":"survey","TransectStyleComplexItem":)"
                             R"({"CameraCalc":{"DistanceToSurface":80,"DistanceMode":3},"Items":[)" +
                             simple_item(16, "47.2", "8.2", 0, "612.5") + "]}}";
  const std::string items = simple_item(22, "47.391", "8.541", 3, "50") + "," +  // take-off
                            simple_item(16, "47.1", "8.1", 6, "120") + "," +     //
                            survey + "," +                                       //
                            simple_item(16, "47.3", "8.3", 5, "700") + "," +     //
                            simple_item(16, "47.4", "8.4", 10, "90") + "," +     //
                            simple_item(16, "47.5", "8.5", 11, "95") + "," +     //
                            simple_item(20, "0", "0", 2, "0");
  const Route route = parse_route(plan(items));
  EXPECT_THAT(heights_of(route), ElementsAre(above_home(0), above_home(50), above_home(120), above_sea(612.5),
                                             above_sea(700), above_ground(90), above_ground(95), above_ground(95)));
  EXPECT_DOUBLE_EQ(route.home.position.lat_deg, 47.39);
  EXPECT_EQ(route.home.above_sea_m, 488.0);
  EXPECT_EQ(route.places[0].name, "the home");
  EXPECT_EQ(route.places[3].name, "item 3") << "of a part of a survey, that of the survey";
}

TEST(Routes, OfAPlanThatTakesOffWhereItIsBeginAsHighAsItClimbs) {
  const Route route = parse_route(plan(simple_item(22, "0", "0", 3, "60") + "," + simple_item(16, "47.1", "8.1")));
  EXPECT_THAT(heights_of(route), ElementsAre(above_home(60), above_home(50)));
}

TEST(Routes, OfAPlanHaveHeightsOnlyWhereItTellsThem) {
  const auto landing = [](const std::string& told) {
    return R"({"type":"ComplexItem","complexItemType":"fwLandingPattern",)" + told +
           R"("landingApproachCoordinate":[47.3,8.3,40],"landCoordinate":[47.4,8.4,0]})";
  };
  const std::string items = simple_item(16, "47.1", "8.1", 3, "null") + "," +  // the ground is not known to QGC yet
                            simple_item(16, "47.2", "8.2", 2, "50") + "," +    // a frame of no heights
                            R"({"type":"SimpleItem","command":16,"params":[0,0,0,0,47.3,8.3]},)" + landing("") + "," +
                            landing(R"("altitudesAreRelative":true,)") + "," +
                            landing(R"("altitudesAreRelative":false,)");
  const Height none;
  const Route route = parse_route(plan(items, "[0,0,0]"));
  EXPECT_THAT(heights_of(route),
              ElementsAre(none, none, none, none, none, above_home(40), above_home(0), above_sea(40), above_sea(0)));
  EXPECT_DOUBLE_EQ(route.home.position.lat_deg, 47.1) << "no home is told: its first place";
  EXPECT_FALSE(route.home.above_sea_m);
}

// The first lines are those of mavlink.io/en/file_formats.
TEST(Routes, OfAWaypointListBeginAtItsFirstItemAndEndThereAgainWhereTheyReturn) {
  const Route route = parse_route(
      "QGC WPL 110\r\n"
      "0\t1\t0\t16\t0.149999999999999994\t0\t0\t0\t8.54800000000000004\t47.3759999999999977\t550\t1\r\n"
      "1\t0\t0\t16\t0.149999999999999994\t0\t0\t0\t8.54900000000000004\t47.3759999999999977\t550\t1\r\n"
      "2  0  3  178  0 20 0 0  0 0 0  1\r\n"
      "3\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1\r\n"
      "\r\n");
  EXPECT_THAT(route.places, ElementsAre(place(8.548, 47.376), place(8.549, 47.376), place(8.548, 47.376)));
  EXPECT_THAT(heights_of(route), ElementsAre(above_home(0), above_sea(550), above_sea(550)));
  EXPECT_EQ(route.home.above_sea_m, 550.0);
  EXPECT_EQ(route.places[1].name, "line 3");
}

TEST(Routes, OfAWaypointListWhoseHomeIsNotSetBeginInTheAirAtItsFirstPlace) {
  const Route route = parse_route(
      "QGC WPL 110\n"
      "0 1 0 16 0 0 0 0 0 0 0 1\n"
      "1 0 3 22 0 0 0 0 0 0 30 1\n"
      "2 0 0 16 0 0 0 0 47.1 8.1 600 1\n"
      "3 0 3 16 0 0 0 0 47.2 8.2 100 1\n");
  EXPECT_THAT(route.places, ElementsAre(place(47.1, 8.1), place(47.2, 8.2)));
  EXPECT_THAT(heights_of(route), ElementsAre(above_sea(600), above_home(100)));
  EXPECT_FALSE(route.home.above_sea_m) << "600 m is how high it flies";
}

TEST(Routes, OfAWaypointListPassOverComments) {
  const Route route = parse_route(
      "QGC WPL 110\r\n"
      "# saved by MAVProxy\r\n"
      "0\t1\t0\t16\t0\t0\t0\t0\t47.1\t8.1\t550\t1\r\n"
      "  #\r\n"
      "1\t0\t3\t16\t0\t0\t0\t0\t47.2\t8.2\t100\t1\r\n");
  EXPECT_THAT(route.places, ElementsAre(place(47.1, 8.1), place(47.2, 8.2)));
  EXPECT_EQ(route.places[1].name, "line 5");
}

TEST(Routes, OfAWaypointListCountHeightsAsItsThirdColumnSays) {
  const Route route = parse_route(
      "QGC WPL 110\n"
      "0 1 0 16 0 0 0 0 47.1 8.1 550 1\n"
      "1 0 3 22 0 0 0 0 0 0 30 1\n"
      "2 0 3 16 0 0 0 0 47.2 8.2 100 1\n"
      "3 0 10 16 0 0 0 0 47.3 8.3 110 1\n"
      "4 0 2 16 0 0 0 0 47.4 8.4 120 1\n");
  EXPECT_THAT(heights_of(route), ElementsAre(above_home(30), above_home(100), above_ground(110), Height{}));
  const Route not_at_home = parse_route("QGC WPL 110\n0 1 3 16 0 0 0 0 47 8 80 1\n1 0 3 16 0 0 0 0 47 9 80 1\n");
  EXPECT_EQ(not_at_home.places[0].height, above_home(80)) << "its first line is in the air";
}

TEST(Routes, OfGeoJsonAreTheFirstLineOrAllPoints) {
  const std::string line = R"({"type":"LineString","coordinates":[[21,57.5],[21.01,57.6,300]]})";
  const std::string point = R"({"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}})";
  const auto feature = [](const std::string& geometry) { return R"({"type":"Feature","geometry":)" + geometry + "}"; };
  const auto collection = [](const std::string& features) {
    return R"({"type":"FeatureCollection","features":[)" + features + "]}";
  };
  const auto drawn = ElementsAre(place(57.5, 21), place(57.6, 21.01));
  EXPECT_THAT(parse_route(line).places, drawn);
  EXPECT_THAT(heights_of(parse_route(line)), ElementsAre(Height{}, above_sea(300)));
  EXPECT_EQ(parse_route(line).places[1].name, "place 2");
  EXPECT_DOUBLE_EQ(parse_route(line).home.position.lat_deg, 57.5);
  EXPECT_THAT(parse_route(feature(line)).places, drawn);
  EXPECT_THAT(parse_route(collection(point + "," + feature("null") + "," + feature(line))).places, drawn);
  const Route of_two = parse_route(collection(feature(line) + "," + point + "," + feature(line)));
  EXPECT_THAT(of_two.places, drawn);
  EXPECT_THAT(of_two.left_out, ElementsAre(HasSubstr("geometry 3, a LineString")));
  EXPECT_THAT(parse_route(collection(point + "," + point)).places, ElementsAre(place(2, 1), place(2, 1)));
  EXPECT_THAT(parse_route("\xEF\xBB\xBF" + feature(R"({"type":"MultiLineString","coordinates":)"
                                                   R"([[[179,1],[180,1]],[[-180,1],[-179,1]]]})"))
                  .places,
              ElementsAre(place(1, 179), place(1, 180), place(1, -180), place(1, -179)));
}

TEST(Routes, OfGeoJsonWhoseHeightsAreAllZeroTellNone) {
  const auto heights = [](const char* first, const char* second) {
    return heights_of(parse_route(std::string(R"({"type":"LineString","coordinates":[[21,57.5,)") + first +
                                  "],[21.01,57.6," + second + "]]}"));
  };
  EXPECT_THAT(heights("0", "0.0"), ElementsAre(Height{}, Height{}));
  EXPECT_THAT(heights("0", "120"), ElementsAre(above_sea(0), above_sea(120)));
}

TEST(Routes, OfGeoJsonAreFoundInCollectionsOfGeometries) {
  const auto collection = [](const std::string& members) {
    return R"({"type":"GeometryCollection","geometries":[)" + members + "]}";
  };
  const std::string line = R"({"type":"LineString","coordinates":[[21,57.5],[21.01,57.6]]})";
  const auto drawn = ElementsAre(place(57.5, 21), place(57.6, 21.01));
  EXPECT_THAT(parse_route(collection(line)).places, drawn);
  EXPECT_THAT(parse_route(R"({"type":"Feature","geometry":)" + collection(line) + "}").places, drawn);
  EXPECT_THAT(parse_route(R"({"type":"MultiPoint","coordinates":[[21,57.5],[21.01,57.6]]})").places, drawn);
}

TEST(Routes, ThatCannotBeReadAreRefusedWithTheirPlaceInTheFile) {
  const auto complaint = [](const std::string& text) {
    EXPECT_EQ(code_of([&] { parse_route(text); }), "waypoints-unreadable") << text;
    return message_of([&] { parse_route(text); });
  };
  EXPECT_THAT(complaint("not json"), HasSubstr("a plan of QGroundControl"));
  EXPECT_THAT(complaint("[]"), HasSubstr("must be an object"));
  EXPECT_THAT(complaint(R"({"features":[]})"), HasSubstr("at least two places"));
  EXPECT_THAT(complaint(R"({"type":"Point","coordinates":[21]})"), HasSubstr("coordinates"));
  EXPECT_THAT(complaint(R"({"geometry":{"type":"Polygon","coordinates":[[[1,2],[1,3],[2,3],[1,2]]]}})"),
              HasSubstr("geometry is a polygon, which tells no way"));
  EXPECT_THAT(complaint(R"({"type":"LineString","coordinates":[[47,121.5],[1,2]]})"),
              HasSubstr("coordinates[0][1] is 121.5"));
  EXPECT_THAT(complaint(plan(R"({"type":"SimpleItem","command":16,"params":[1,2]})")),
              HasSubstr("mission.items[0].params has to hold seven numbers"));
  EXPECT_THAT(complaint(plan(simple_item(16, "\"47\"", "8"))), HasSubstr("mission.items[0].params[4]"));
  EXPECT_THAT(complaint(plan("")), HasSubstr("at least two places"));
  EXPECT_THAT(complaint("QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 50\n"), HasSubstr("line 2 has 11 numbers"));
  EXPECT_THAT(complaint("QGC WPL 100\n0 3 16 0 0 50 0 1 8 47 0 50 1\n"), HasSubstr("line 2 has 13 numbers"));
  EXPECT_THAT(complaint("QGC WPL 110\n\n0 1 0 16 0 0 0 0 x 8 50 1\n"), HasSubstr("line 3: 'x' is no number"));
  EXPECT_THAT(complaint("QGC WPL 110\n0 1 0 16 0 0 0 0 97 8 50 1\n"), HasSubstr("line 2: latitude 97"));
  EXPECT_THAT(complaint("QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 1e9 1\n"), HasSubstr("line 2: 1000000000 m are no height"));
  EXPECT_THAT(complaint(plan(simple_item(16, "47", "8", 3, "-1e9"))), HasSubstr("mission.items[0].params[6]"));
}

TEST(Routes, OfFilesAreRefusedByTheirName) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "mission.plan") << "{}";
  EXPECT_THAT(message_of([&] { read_route(folder / "mission.plan"); }), HasSubstr("mission.plan: route: "));
  EXPECT_EQ(code_of([&] { read_route(folder / "none"); }), "file-not-found");
}

}  // namespace
}  // namespace roadfix::routes
