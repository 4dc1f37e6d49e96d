#include "tiles/roads/road_rules.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>

#include "tests/support/code_of.hpp"
#include "tiles/roads/osm_tags.hpp"

namespace roadfix {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::Pair;
using Tags = std::map<std::string, std::string, std::less<>>;

std::optional<double> width(const Tags& tags, const RoadRules& rules = {}, bool classified = true) {
  const auto lookup = [&tags](std::string_view key) {
    const auto found = tags.find(key);
    return found != tags.end() ? found->second : std::string();
  };
  return rules.width_of(lookup, classified);
}

TEST(RoadRules, GiveEachClassAWidth) {
  EXPECT_THAT(width({{"highway", "residential"}}), Optional(6.0));
  EXPECT_THAT(width({{"highway", "motorway"}}), Optional(12.0));
}

TEST(RoadRules, LeaveOutWhatACameraAboveDoesNotSeeAsARoad) {
  for (const Tags& tags : {Tags{{"highway", "footway"}},
                           {{"highway", "steps"}},
                           {{"highway", "proposed"}},
                           {{"highway", "construction"}},
                           {{"highway", "residential"}, {"tunnel", "yes"}},
                           {{"highway", "service"}, {"tunnel", "building_passage"}},
                           {{"highway", "service"}, {"covered", "yes"}},
                           {{"highway", "pedestrian"}, {"indoor", "yes"}},
                           {{"highway", "pedestrian"}, {"level", "-1"}},
                           {{"highway", "residential"}, {"abandoned", "yes"}},
                           {{"highway", "residential"}, {"location", "underground"}},
                           {{"highway", "a class nobody knows"}},
                           {{"waterway", "river"}}}) {
    EXPECT_EQ(width(tags), std::nullopt) << tags.rbegin()->first << '=' << tags.rbegin()->second;
  }
}

TEST(RoadRules, KeepARoadThatIsOnlyNotATunnel) {
  EXPECT_THAT(width({{"highway", "residential"}, {"tunnel", "no"}}), Optional(6.0));
  EXPECT_THAT(width({{"highway", "pedestrian"}, {"level", "0"}}), Optional(6.0));
}

TEST(RoadRules, KnowTheTunnelsAndClassesOfVectorTilesAndOverture) {
  for (const Tags& tags : {Tags{{"highway", "secondary"}, {"brunnel", "tunnel"}},
                           {{"highway", "street"}, {"structure", "tunnel"}},
                           {{"highway", "primary"}, {"road_flags", R"([{"values":["is_link","is_tunnel"]}])"}},
                           {{"highway", "primary"}, {"road_flags", R"([{"values":["is_abandoned"],"between":null}])"}},
                           {{"highway", "primary"}, {"road_flags", "(1:is_under_construction)"}}}) {
    EXPECT_EQ(width(tags), std::nullopt) << tags.rbegin()->first << '=' << tags.rbegin()->second;
  }
  EXPECT_THAT(width({{"highway", "minor"}, {"brunnel", "bridge"}}), Optional(6.0));
  EXPECT_THAT(width({{"highway", "street"}, {"structure", "none"}}), Optional(6.0));
  EXPECT_THAT(width({{"highway", "primary"}, {"road_flags", R"([{"values":["is_bridge"]}])"}}), Optional(10.0));
}

TEST(RoadRules, HideASegmentOfOvertureOfWhichMostIsHidden) {
  const auto flagged = [](const char* between) {
    return Tags{{"highway", "primary"},
                {"road_flags",
                 fmt::format(R"([{{"values":["is_bridge"]}},{{"values":["is_tunnel"],"between":{}}}])", between)}};
  };
  EXPECT_THAT(width(flagged("[0.1,0.3]")), Optional(10.0));
  EXPECT_EQ(width(flagged("[0.1,0.9]")), std::nullopt);
}

TEST(RoadRules, BelieveTheFeatureItselfFirst) {
  EXPECT_THAT(width({{"highway", "residential"}, {"width", "4.5 m"}}), Optional(4.5));
  EXPECT_THAT(width({{"highway", "primary"}, {"lanes", "4"}}), Optional(14.0));
  EXPECT_THAT(width({{"highway", "primary"}, {"lanes", "4"}, {"width", "11"}}), Optional(11.0));
  EXPECT_THAT(width({{"highway", "primary"}, {"lanes", "many"}}), Optional(10.0));
}

TEST(RoadRules, TakeTheUsersAttributeAndWidthBeforeTheTable) {
  RoadRules rules;
  rules.set_width_m(3.0);
  EXPECT_THAT(width({{"highway", "primary"}, {"lanes", "4"}}, rules), Optional(3.0));
  rules.set_width_attribute("carriageway");
  EXPECT_THAT(width({{"highway", "primary"}, {"carriageway", "8"}}, rules), Optional(8.0));
}

TEST(RoadRules, TakePlainNumbersOfTheUsersAttributeForFeetWhereTheUserSaysSo) {
  RoadRules rules;
  rules.set_width_attribute("WIDTH:ft");
  const auto in_feet = [](double width_m) { return Optional(::testing::DoubleNear(width_m * 0.3048, 1e-9)); };
  EXPECT_THAT(width({{"highway", "primary"}, {"WIDTH", "24"}}, rules), in_feet(24.0));
  EXPECT_THAT(width({{"highway", "primary"}, {"WIDTH", "12'6\""}}, rules), in_feet(12.5));
  EXPECT_THAT(width({{"highway", "primary"}, {"WIDTH", "7 m"}}, rules), Optional(7.0));
  EXPECT_THAT(rules.describe(), ::testing::HasSubstr("width-attribute=WIDTH:ft"));
  rules.set_width_attribute("width:ft");
  EXPECT_THAT(width({{"highway", "primary"}, {"width", "1"}}, rules), Optional(10.0)) << "no road, nor one metre";
  rules.set_width_attribute("width:carriageway:m");
  EXPECT_THAT(width({{"highway", "primary"}, {"width:carriageway", "7"}}, rules), Optional(7.0));
  EXPECT_EQ(rules.unit_of("width:carriageway"), WidthUnit::kMetre);
}

TEST(RoadRules, DrawEveryLineOfALayerWithoutClasses) {
  EXPECT_THAT(width({}, {}, false), Optional(6.0));
  EXPECT_EQ(width({{"tunnel", "yes"}}, {}, false), std::nullopt);
}

TEST(RoadRules, DrawExactlyTheSelectedClasses) {
  RoadRules rules;
  rules.select("footway,primary");
  EXPECT_THAT(width({{"highway", "footway"}}, rules), Optional(2.0));
  EXPECT_EQ(width({{"highway", "residential"}}, rules), std::nullopt);
  EXPECT_EQ(testing::code_of([&] { rules.select("primary,autobahn"); }), "road-class-unknown");
}

TEST(RoadRules, TakeClassesWhateverTheirCaseAndOuterBlanks) {
  for (const char* name : {"Primary", "PRIMARY", " primary ", "primary\t"}) {
    EXPECT_THAT(width({{"highway", name}}), Optional(10.0)) << name;
    EXPECT_TRUE(RoadRules().knows(name)) << name;
  }
  EXPECT_EQ(width({{"highway", "Footway"}}), std::nullopt);
  EXPECT_EQ(width({{"highway", "prim ary"}}), std::nullopt);
  EXPECT_FALSE(RoadRules().knows("STRASSE"));
  RoadRules rules = RoadRules::parse("Boulevard 20 yes\nALLEY 2 no\n");
  EXPECT_THAT(width({{"highway", "BOULEVARD"}}, rules), Optional(20.0));
  rules.select("alley , Boulevard");
  EXPECT_THAT(width({{"highway", "Alley"}}, rules), Optional(2.0));
  EXPECT_THAT(width({{"highway", "primary"}, {"tunnel", "NO"}}), Optional(10.0));
  EXPECT_THAT(width({{"highway", "primary"}, {"tunnel", "N"}}), Optional(10.0));
  EXPECT_EQ(width({{"highway", "primary"}, {"abandoned", "Yes"}}), std::nullopt);
}

TEST(RoadRules, TakeTheFirstKnownClassOfAList) {
  for (const char* list : {"['residential', 'primary']", "(2:residential,primary)", "[ \"odd\", \"Residential\" ]"}) {
    EXPECT_THAT(width({{"highway", list}}), Optional(6.0)) << list;
  }
  EXPECT_EQ(width({{"highway", "['footway', 'residential']"}}), std::nullopt);
  EXPECT_EQ(width({{"highway", "['pedestrian', 'service']"}, {"level", "-1"}}), std::nullopt);
  for (const char* unknown : {"['odd']", "[", "[]", "(", "residential,primary"}) {
    EXPECT_FALSE(RoadRules().knows(unknown)) << unknown;
  }
}

TEST(RoadRules, AreReadFromATable) {
  const RoadRules rules = RoadRules::parse("# mine\nboulevard 20 yes  # wide\n\nalley 2 no\n");
  EXPECT_THAT(width({{"highway", "boulevard"}}, rules), Optional(20.0));
  EXPECT_EQ(width({{"highway", "alley"}}, rules), std::nullopt);
  for (const char* wrong : {"road six yes", "road 6 maybe", "road 6", "road -1 yes", "road 6 yes more"}) {
    EXPECT_EQ(testing::code_of([&] { RoadRules::parse(wrong); }), "rules-unreadable") << wrong;
  }
}

TEST(RoadRules, ReadClassesWithBlanks) {
  RoadRules rules = RoadRules::parse("Main Road 8 yes\r\nA road,  single carriageway \t 7 no  # national\r\n");
  EXPECT_THAT(width({{"highway", "Main Road"}}, rules), Optional(8.0));
  EXPECT_FALSE(rules.knows("main"));
  EXPECT_TRUE(rules.knows("A road,  single carriageway"));
  EXPECT_EQ(width({{"highway", "A road,  single carriageway"}}, rules), std::nullopt);
  rules.select("main road");
  EXPECT_THAT(width({{"highway", "Main Road"}}, rules), Optional(8.0));
  for (const char* wrong : {"6 yes", " 6 yes", "Main Road yes", "Main Road 8", "Main Road 8 yes please", "8", "yes"}) {
    EXPECT_EQ(testing::code_of([&] { RoadRules::parse(wrong); }), "rules-unreadable") << wrong;
  }
}

TEST(RoadRules, AreReadFromATableOfAnyEditorInUtf8Alone) {
  const RoadRules rules = RoadRules::parse("\xef\xbb\xbfHauptstra\xc3\x9f\x65 8 yes\r\n");
  EXPECT_THAT(width({{"highway", "Hauptstra\xc3\x9f\x65"}}, rules), Optional(8.0));
  EXPECT_THAT(testing::message_of([&] { RoadRules::parse("# Stra\xdf\x65n\nHauptstra\xdf\x65 8 yes\n"); }),
              ::testing::HasSubstr("line 2 of the road rules is not in UTF-8"));
  EXPECT_EQ(testing::code_of([&] { RoadRules::parse("\xff\xfer 6 yes"); }), "rules-unreadable") << "UTF-16";
}

TEST(WidthText, IsMetresUnlessItSaysOtherwise) {
  EXPECT_THAT(parse_width_m("7.5"), Optional(7.5));
  EXPECT_THAT(parse_width_m("7,5 m"), Optional(7.5));
  EXPECT_THAT(parse_width_m("20'"), Optional(::testing::DoubleNear(6.096, 1e-9)));
  EXPECT_THAT(parse_width_m(" 6 "), Optional(6.0));
  EXPECT_THAT(parse_width_m("6.0 Metres"), Optional(6.0));
  EXPECT_THAT(parse_width_m("10 FT"), Optional(::testing::DoubleNear(3.048, 1e-9)));
  EXPECT_THAT(parse_width_m("12'6\""), Optional(::testing::DoubleNear(3.81, 1e-9)));
  for (const char* wrong : {"", "narrow", "1.2.3", "0", "500", "-3", "5 km", "5;6", "12'x", "6\""}) {
    EXPECT_EQ(parse_width_m(wrong), std::nullopt) << wrong;
  }
}

TEST(Hstore, GivesKeysAndValuesWithEscapesUndone) {
  EXPECT_THAT(parse_hstore(R"("lanes"=>"2","name"=>"a \"quoted\" \\ one", "x" => "y")"),
              ElementsAre(Pair("lanes", "2"), Pair("name", "a \"quoted\" \\ one"), Pair("x", "y")));
  EXPECT_THAT(parse_hstore(R"("a"=>NULL,"b"=>"")"), ElementsAre(Pair("b", "")));
}

TEST(PackedTags, AreReadFromJsonToo) {
  EXPECT_THAT(
      parse_tags(R"( {"lanes":"2","width":7.5,"oneway":null,"name":"a \"quoted\" one","a/b":"c"})"),
      ElementsAre(Pair("a/b", "c"), Pair("lanes", "2"), Pair("name", "a \"quoted\" one"), Pair("width", "7.5")));
  EXPECT_THAT(parse_tags(R"("lanes"=>"2")"), ElementsAre(Pair("lanes", "2")));
  EXPECT_THAT(parse_tags(R"({"lanes":"2","wid)"), IsEmpty());
}

TEST(Hstore, KeepsWhatStandsBeforeTheDamage) {
  EXPECT_THAT(parse_hstore(R"("a"=>"1","b"=>"cut o)"), ElementsAre(Pair("a", "1")));
  EXPECT_THAT(parse_hstore("a=>1"), IsEmpty());
  EXPECT_THAT(parse_hstore(""), IsEmpty());
  EXPECT_THAT(parse_hstore(R"("a")"), IsEmpty());
}

}  // namespace
}  // namespace roadfix
