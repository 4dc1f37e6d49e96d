#include "server/api/base64.hpp"

#include <gtest/gtest.h>

#include <random>

namespace roadfix::api {
namespace {

std::vector<std::uint8_t> bytes(std::string_view text) { return {text.begin(), text.end()}; }

// RFC 4648 section 10.
TEST(Base64, GivesTheVectorsOfTheStandardBothWays) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : vectors) {
    EXPECT_EQ(base64_encoded(bytes(plain)), coded);
    EXPECT_EQ(base64_decoded(coded).bytes, bytes(plain));
  }
  EXPECT_EQ(base64_decoded("Zm8").bytes, bytes("fo")) << "padding may be left out";
}

TEST(Base64, ReturnsWhatWasEncodedForRandomBytesOfEveryLength) {
  std::mt19937_64 random(1);
  for (std::size_t n = 0; n < 200; ++n) {
    std::vector<std::uint8_t> data(n);
    for (auto& byte : data) byte = static_cast<std::uint8_t>(random());
    EXPECT_EQ(base64_decoded(base64_encoded(data)).bytes, data);
  }
}

TEST(Base64, PointsAtTheFirstCharacterThatDoesNotBelong) {
  EXPECT_EQ(base64_decoded("Zm9v!mFy").bad_byte, 4U);
  EXPECT_EQ(base64_decoded("Zm=vYmFy").bad_byte, 2U);
  EXPECT_EQ(base64_decoded("Zm9vY").bad_byte, 4U);
  EXPECT_EQ(base64_decoded("====").bad_byte, 0U);
}

}  // namespace
}  // namespace roadfix::api
