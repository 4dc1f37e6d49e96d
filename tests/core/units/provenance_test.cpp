#include "core/units/provenance.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace roadfix {
namespace {

TEST(Provenance, OfOneIsItself) {
  const std::vector one{Provenance{"2020-05", "CC-BY", "X", 30.0}};
  EXPECT_EQ(combined(one), one.front());
  EXPECT_EQ(credits_of(one), "X (CC-BY)");
  EXPECT_EQ(combined({}), Provenance{});
}

TEST(Provenance, OfSeveralIsTheOldestTheLeastExactAndAllCredits) {
  const std::vector alike{Provenance{"2021", "ODbL", "OSM", 4.0}, {"2019-03", "ODbL", "City", 2.5}, {"", "", "", 9.0}};
  EXPECT_EQ(combined(alike), (Provenance{"2019-03", "ODbL", "OSM; City", 9.0}));
  const std::vector mixed{Provenance{"", "ODbL", "OSM", 4.0}, {"", "ODbL", "OSM", 2.5}, {"", "CC0", "", 2.5}};
  EXPECT_EQ(credits_of(mixed), "OSM (ODbL); CC0");
  EXPECT_EQ(combined(mixed), (Provenance{"", "", "OSM (ODbL); CC0", 4.0}));
}

TEST(Provenance, CreditsSurviveBeingCombinedAgain) {
  const std::vector mixed{Provenance{"", "ODbL", "OSM", 4.0}, {"", "CC0", "Y", 2.5}};
  const std::vector once{combined(mixed)};
  EXPECT_EQ(credits_of(once), credits_of(mixed));
  EXPECT_EQ(combined(once), once.front());
}

TEST(Provenance, TheDetectorOfAMethodIsReadAsMapsHaveIt) {
  const std::string detector = "neural roadnet-7 fnv1a64=00f3a5d1c2b4e697 gsd_m=1 orientations=1";
  const std::string method = detector + "; pixels of 1 m, values 0..255, one colour over 16 m unseen";
  EXPECT_EQ(method_by(detector, "pixels of 1 m, values 0..255, one colour over 16 m unseen"), method);
  EXPECT_EQ(detector_in(method), detector);
  EXPECT_EQ(detector_in(detector), detector);
}

}  // namespace
}  // namespace roadfix
