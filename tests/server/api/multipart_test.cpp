#include "server/api/multipart.hpp"

#include <gtest/gtest.h>

#include "tests/support/code_of.hpp"

namespace roadfix::api {
namespace {

constexpr const char* kType = "multipart/form-data; boundary=\"b-1\"";

TEST(Multipart, SplitsPartsWithNames) {
  const std::string body =
      "preamble\r\n--b-1\r\nContent-Disposition: form-data; filename=\"a;name=x.png\"; name=\"image\"\r\n"
      "Content-Type: Image/PNG; x=y\r\n\r\nab\r\n--b-\r\ncd\r\n--b-1\r\ncontent-disposition: form-data; "
      "name=cell_m\r\n\r\n2\r\n"
      "--b-1--\r\nepilogue";
  const auto parts = parse_multipart(kType, body);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].name, "image");
  EXPECT_EQ(parts[0].content, "ab\r\n--b-\r\ncd");
  EXPECT_EQ(parts[1].name, "cell_m");
  EXPECT_EQ(parts[1].content, "2");
}

TEST(Multipart, RefusesWhatIsNotWhole) {
  const std::string head = "--b-1\r\nContent-Disposition: form-data; name=a\r\n\r\n";
  for (const std::string& body :
       {std::string(), std::string("x"), std::string("--b-1"), std::string("--b-1\r\n"), head, head + "abc",
        head + "abc\r\n--b-1", std::string("--b-1\r\nContent-Type: text/plain\r\n\r\nx\r\n--b-1--"),
        std::string("--b-1\r\nno colon\r\n\r\n--b-1--"),
        std::string("--b-1\r\nContent-Disposition: form-data\r\n\r\nx\r\n--b-1--")}) {
    EXPECT_EQ(roadfix::testing::code_of([&] { parse_multipart(kType, body); }), "bad-multipart") << body;
  }
  for (const char* type : {"multipart/form-data", "multipart/form-data; boundary="}) {
    EXPECT_EQ(roadfix::testing::code_of([&] { parse_multipart(type, head); }), "bad-multipart") << type;
  }
}

TEST(Multipart, BoundsTheNumberOfParts) {
  std::string body = "--b-1";
  for (int i = 0; i < 65; ++i) body += "\r\nContent-Disposition: form-data; name=a\r\n\r\n\r\n--b-1";
  EXPECT_EQ(roadfix::testing::code_of([&] { parse_multipart(kType, body + "--"); }), "too-many-parts");
}

}  // namespace
}  // namespace roadfix::api
