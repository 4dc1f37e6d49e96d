#include "server/api/media.hpp"

#include <gtest/gtest.h>

#include "core/units/error.hpp"

namespace roadfix::api {
namespace {

constexpr Media kOffered[] = {{"png", "image/png"}, {"tiff", "image/tiff"}, {"json", "application/json"}};

TEST(Media, FollowsQualityAndTheMostSpecificRange) {
  EXPECT_EQ(negotiated("", kOffered).name, "png");
  EXPECT_EQ(negotiated("*/*", kOffered).name, "png");
  EXPECT_EQ(negotiated("application/json", kOffered).name, "json");
  EXPECT_EQ(negotiated("text/html, Application/JSON;q=0.9, */*;q=0.1", kOffered).name, "json");
  EXPECT_EQ(negotiated("image/*, image/png;q=0.2", kOffered).name, "tiff");
  EXPECT_EQ(negotiated("image/png; q=0.3, image/tiff ;q=0.4", kOffered).name, "tiff");
}

TEST(Media, FollowsTheFieldBeforeTheHeader) {
  http::Request request;
  request.headers["accept"] = "image/tiff";
  EXPECT_EQ(media_asked_for(request, Fields(http::Parameters{}), kOffered).name, "tiff");
  EXPECT_EQ(media_asked_for(request, Fields(http::Parameters{{"format", "json"}}), kOffered).name, "json");
  EXPECT_THROW(media_asked_for(request, Fields(http::Parameters{{"format", "gif"}}), kOffered), InvalidInput);
}

TEST(Media, RefusesWhatMatchesNothing) {
  EXPECT_THROW(negotiated("text/html", kOffered), InvalidInput);
  EXPECT_THROW(negotiated("image/png;q=0", kOffered), InvalidInput);
}

}  // namespace
}  // namespace roadfix::api
