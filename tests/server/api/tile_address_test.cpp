#include "server/api/tile_address.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "core/units/error.hpp"

namespace roadfix::api {
namespace {

TEST(TileAddress, RefusesWhatIsNoTile) {
  EXPECT_NO_THROW(parse_tile("0", "0", "0"));
  EXPECT_NO_THROW(parse_tile("24", "16777215", "0"));
  for (const auto& [z, x, y] : {std::tuple{"25", "0", "0"},
                                {"1", "2", "0"},
                                {"1", "0", "-1"},
                                {"a", "0", "0"},
                                {"1", "0 ", "0"},
                                {"1", "01", "0"},
                                {"00", "0", "0"},
                                {"1", "-0", "0"},
                                {"", "0", "0"}}) {
    EXPECT_THROW(parse_tile(z, x, y), NotFound);
  }
}

}  // namespace
}  // namespace roadfix::api
