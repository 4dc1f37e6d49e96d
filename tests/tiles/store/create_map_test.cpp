#include "tiles/store/create_map.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/code_of.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

TEST(CreateMap, LeavesNothingBesideANameThatItCannotTake) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "m.gpkg" / "inside");
  EXPECT_EQ(testing::code_of([&] { create_map(folder / "m.gpkg", testing::settings_37n()); }), "map-not-writable");
  EXPECT_FALSE(std::filesystem::exists(folder / "m.gpkg-new"));
}

}  // namespace
}  // namespace roadfix
