#include "core/units/bytes.hpp"

#include <gtest/gtest.h>

#include <array>

namespace roadfix {
namespace {

TEST(Bytes, AreTheSameAsCharacters) {
  constexpr std::string_view kText("a\0\xff", 3);
  ASSERT_EQ(bytes_of(kText).size(), 3U);
  EXPECT_EQ(bytes_of(kText)[2], 0xff);
  EXPECT_EQ(characters_of(bytes_of(kText)), kText);
  EXPECT_TRUE(bytes_of({}).empty());
}

TEST(Bytes, AreNumbersWithTheMostSignificantFirst) {
  constexpr std::array<std::uint8_t, 4> kBytes{0x01, 0x02, 0xfe, 0xff};
  EXPECT_EQ(big_endian(kBytes), 0x0102feff);
  EXPECT_EQ(big_endian(Bytes(kBytes).last(2)), 0xfeff);
  EXPECT_EQ(big_endian({}), 0);
}

}  // namespace
}  // namespace roadfix
