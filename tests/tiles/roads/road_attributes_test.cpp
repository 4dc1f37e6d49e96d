// What of a feature says that it is a road, and how wide.
#include "tiles/roads/road_lines.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/support/code_of.hpp"
#include "tests/tiles/roads/road_features.hpp"
#include "tiles/roads/vector_roads.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using testing::at;
using ::testing::ElementsAre;
using testing::feature;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kZone;
using testing::message_of;

using RoadAttributes = testing::RoadFeatures;

TEST_F(RoadAttributes, ClassesOfGeofabriksExtractsAreKnown) {
  const std::string path = geojson({feature(R"("fclass":"primary")", at(-150, 40), at(150, 40)),
                                    feature(R"("fclass":"footway")", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 1U);
  EXPECT_EQ(network.lines.front().half_width_m, 5.0);
}

TEST_F(RoadAttributes, TracksOfGeofabriksExtractsHaveAGradeAndAreDrawn) {
  std::vector<std::string> roads;
  for (int grade = 1; grade <= 5; ++grade) {
    roads.push_back(feature(fmt::format(R"("fclass":"track_grade{}")", grade), at(-150, 9 * grade), at(150, 40)));
  }
  roads.push_back(feature(R"("fclass":"unknown")", at(-150, -40), at(150, -40)));
  const RoadNetwork network = read_road_network({geojson(roads)}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 6U);
  EXPECT_EQ(network.lines.front().half_width_m, 1.5);
  EXPECT_EQ(network.lines.back().half_width_m, 3.0);
}

TEST_F(RoadAttributes, AFewKnownClassesInGeofabriksAttributeAreEnough) {
  const auto lines_with = [&](const std::string& attribute, const RoadRules& rules) {
    std::vector<std::string> roads{feature(fmt::format(R"("{}":"residential")", attribute), at(-9, 0), at(9, 0))};
    for (int i = 0; i < 8; ++i) {
      roads.push_back(feature(fmt::format(R"("{}":"goat_walk")", attribute), at(-9, i + 10), at(9, i + 10)));
    }
    return read_road_network({geojson(roads)}, {}, rules, kZone).lines.size();
  };
  EXPECT_EQ(lines_with("fclass", RoadRules()), 1U);
  EXPECT_EQ(lines_with("type", RoadRules()), 9U) << "no classes of roads, so every line is one";
  EXPECT_EQ(lines_with("fclass", RoadRules::parse("goat_walk 2 yes")), 8U);
}

TEST_F(RoadAttributes, ATableOfFewClassesMakesNoOtherAttributeOfTheClass) {
  const std::string path = geojson({feature(R"("type":"residential")", at(-150, 40), at(150, 40)),
                                    feature(R"("type":"primary")", at(-150, 0), at(150, 0)),
                                    feature(R"("type":"motorway")", at(-150, -40), at(150, -40))});
  EXPECT_EQ(read_road_network({path}, {}, RoadRules::parse("motorway 12 yes"), kZone).lines.size(), 1U);
}

TEST_F(RoadAttributes, AnotherAttributeIsTakenForTheClassWhereItHoldsClassesAndSaidSo) {
  const std::string path = geojson({feature(R"("TYPE":"primary")", at(-150, 40), at(150, 40)),
                                    feature(R"("TYPE":"footway")", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 1U);
  EXPECT_EQ(network.lines.front().half_width_m, 5.0);
  EXPECT_EQ(network.class_attribute, "type");
  EXPECT_THAT(network.notes, ElementsAre(HasSubstr("'type'")));
  EXPECT_THAT(open_road_vectors({path}, {}, RoadRules(), kZone, 2.0)->summary().method, HasSubstr("classes in type"));
}

TEST_F(RoadAttributes, PackedTagsAreReadWhateverProgramPackedThem) {
  for (const char* packed : {R"("other_tags":"\"tunnel\"=>\"no\",\"width\"=>\"7\"")",
                             R"("other_tags":"{\"tunnel\":\"no\",\"width\":\"7\"}")", R"("tags":{"width":"7"})"}) {
    const std::string path =
        geojson({feature(fmt::format(R"("highway":"primary",{})", packed), at(-150, 40), at(150, 40)),
                 feature(R"("highway":"primary","other_tags":"{\"tunnel\":\"yes\"}")", at(-150, 0), at(150, 0)),
                 feature(R"("highway":"primary","other_tags":"{\"damaged")", at(-150, -40), at(150, -40))});
    const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
    ASSERT_EQ(network.lines.size(), 2U) << packed;
    EXPECT_EQ(network.lines.front().half_width_m, 3.5) << packed;
    EXPECT_EQ(network.lines.back().half_width_m, 5.0) << packed;
  }
}

TEST_F(RoadAttributes, WidthsFromAnAttributeAreSaidToBe) {
  const std::string path = geojson({feature(R"("highway":"primary","WIDTH":20)", at(-150, 40), at(150, 40)),
                                    feature(R"("highway":"primary","WIDTH":24)", at(-150, 0), at(150, 0)),
                                    feature(R"("highway":"primary","WIDTH":60)", at(-150, 20), at(150, 20)),
                                    feature(R"("highway":"primary","WIDTH":null)", at(-150, -20), at(150, -20)),
                                    feature(R"("highway":"footway","WIDTH":2)", at(-150, -40), at(150, -40))});
  EXPECT_THAT(read_road_network({path}, {}, RoadRules(), kZone).notes,
              ElementsAre(AllOf(HasSubstr("widths of 3 roads from the attribute 'WIDTH'"), HasSubstr("median 24 m"),
                                HasSubstr("--width-attribute WIDTH:ft"))));
  RoadRules rules;
  rules.set_width_attribute("width:ft");
  const RoadNetwork network = read_road_network({path}, {}, rules, kZone);
  EXPECT_NEAR(network.lines.front().half_width_m, 3.048, 1e-9);
  EXPECT_THAT(network.notes, ElementsAre(HasSubstr("taken for feet: median 7.32 m")));
  rules = RoadRules();
  rules.set_width_m(6.0);
  EXPECT_THAT(read_road_network({path}, {}, rules, kZone).notes, IsEmpty());
  rules.set_width_attribute("breite");
  EXPECT_THAT(read_road_network({path}, {}, rules, kZone).notes,
              ElementsAre(HasSubstr("no road states a width in the attribute 'breite'")));
  const std::string packed =
      geojson({feature(R"("highway":"primary","tags":{"breite":"7"})", at(-150, 40), at(150, 40))});
  EXPECT_THAT(read_road_network({packed}, {}, rules, kZone).notes,
              ElementsAre(HasSubstr("widths of 1 roads from the attribute 'breite'")));
}

TEST_F(RoadAttributes, ClassesAreFoundAmongPackedTags) {
  const std::string path =
      geojson({feature(R"("type":"way","tags":{"power":"line"})", at(-150, 60), at(150, 60)),
               feature(R"("type":"way","tags":{"highway":"primary","lanes":"4"})", at(-150, 40), at(150, 40)),
               feature(R"("type":"way","tags":{"highway":"footway"})", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 1U);
  EXPECT_EQ(network.lines.front().half_width_m, 7.0);
  EXPECT_THAT(network.notes, IsEmpty());
}

TEST_F(RoadAttributes, ClassesInListsAreClasses) {
  const std::string path = geojson({feature(R"("highway":["primary","secondary"])", at(-150, 40), at(150, 40)),
                                    feature(R"("highway":["secondary"])", at(-150, 20), at(150, 20))});
  const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 2U);
  EXPECT_EQ(network.lines.front().half_width_m, 5.0);
  EXPECT_THAT(network.notes, IsEmpty());
}

TEST_F(RoadAttributes, ClassesInCapitalsAreClassesAndUnknownOnesAreNamedAsTheyStand) {
  const std::string path = geojson({feature(R"("ROADTYPE":"PRIMARY")", at(-150, 40), at(150, 40)),
                                    feature(R"("ROADTYPE":"Residential ")", at(-150, 0), at(150, 0)),
                                    feature(R"("ROADTYPE":"Feldweg")", at(-150, -40), at(150, -40))});
  RoadRules rules;
  rules.set_class_attribute("roadtype");
  const RoadNetwork network = read_road_network({path}, {}, rules, kZone);
  ASSERT_EQ(network.lines.size(), 2U);
  EXPECT_EQ(network.lines.front().half_width_m, 5.0);
  EXPECT_EQ(network.lines.back().half_width_m, 3.0);
  EXPECT_THAT(network.notes, ElementsAre(HasSubstr("Feldweg (1)")));
}

TEST_F(RoadAttributes, WordsForNothingAreNoTunnelsAndNoClasses) {
  const std::string path = geojson(
      {feature(R"("highway":"primary","tunnel":"None","covered":"nan","width":"NULL")", at(-150, 40), at(150, 40)),
       feature(R"("highway":"pedestrian","level":"None","indoor":"<Null>")", at(-150, 0), at(150, 0)),
       feature(R"("highway":"None")", at(-150, -20), at(150, -20)),
       feature(R"("highway":"primary","tunnel":"yes")", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
  ASSERT_EQ(network.lines.size(), 2U);
  EXPECT_EQ(network.lines.front().half_width_m, 5.0);
  EXPECT_EQ(network.lines.back().half_width_m, 3.0);
  EXPECT_THAT(network.notes,
              ElementsAre(HasSubstr("1 of 4 lines are not drawn, since their attribute 'highway' is empty")));
}

TEST_F(RoadAttributes, WordsForNothingAmongTheClassesOfAnAttributeDoNotHideThatItHoldsClasses) {
  const std::string path = geojson({feature(R"("type":"primary")", at(-150, 40), at(150, 40)),
                                    feature(R"("type":"None")", at(-150, 0), at(150, 0)),
                                    feature(R"("type":"None")", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({path}, {}, RoadRules(), kZone);
  EXPECT_EQ(network.class_attribute, "type");
  EXPECT_EQ(network.lines.size(), 1U);
}

TEST_F(RoadAttributes, LinesWithoutClassesAreAllRoadsAndSaidSo) {
  const std::string path = geojson({feature(R"("type":"A","lanes":4)", at(-150, 40), at(150, 40)),
                                    feature(R"("type":"primary","lanes":2)", at(-150, -40), at(150, -40)),
                                    feature(R"("type":"B","lanes":2)", at(-150, -90), at(150, -90))});
  const RoadNetwork network = read_road_network({path, path}, {}, RoadRules(), kZone);
  EXPECT_EQ(network.lines.size(), 6U);
  EXPECT_THAT(network.class_attribute, IsEmpty());
  EXPECT_THAT(network.notes, ElementsAre(AllOf(HasSubstr("type, lanes"), HasSubstr("--class-attribute"))));
}

TEST_F(RoadAttributes, ClassesThatNoRuleKnowsAreNamed) {
  const std::string some = geojson({feature(R"("highway":"primary")", at(-150, 40), at(150, 40)),
                                    feature(R"("highway":"Feldweg")", at(-150, 0), at(150, 0)),
                                    feature(R"("highway":"Feldweg")", at(-150, -20), at(150, -20)),
                                    feature(R"("highway":"Autobahn")", at(-150, -40), at(150, -40))});
  const RoadNetwork network = read_road_network({some}, {}, RoadRules(), kZone);
  EXPECT_EQ(network.left_out, 3);
  EXPECT_THAT(network.notes, ElementsAre(AllOf(HasSubstr("3 of 4 lines"), HasSubstr("Feldweg (2), Autobahn (1)"),
                                               HasSubstr("--rules FILE gives widths to them; it replaces"))));
  const std::string none = geojson({feature(R"("highway":"Feldweg")", at(-150, 0), at(150, 0))});
  EXPECT_THAT(message_of([&] { read_road_network({none}, {}, RoadRules(), kZone); }), HasSubstr("Feldweg (1)"));
}

}  // namespace
}  // namespace roadfix
