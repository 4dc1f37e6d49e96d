// What bad input gets: its own clear refusal, and a service that goes on.
#include <gmock/gmock.h>

#include <zlib.h>

#include "tests/e2e/service_fixture.hpp"
#include "tests/support/raw_http.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using testing::RawConnection;
using testing::refusal;
using ::testing::StartsWith;

class BadRequests : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new testing::TemporaryFolder;
    testing::write_map_file(*folder / "town.gpkg", testing::Town().roads, 2.0);
    service = new testing::ServiceProcess(folder->path(), {"--max-body", "1", "--max-poses", "1000", "--max-search",
                                                           "0.5", "--max-pixels", "1000000", "--max-cells", "200000"});
  }
  static void TearDownTestSuite() {
    delete service;
    delete folder;
  }
  void TearDown() override {
    EXPECT_EQ(testing::client_of(*service).Get("/healthz")->status, 200) << "the service goes on";
  }

  static std::string here() {
    const testing::Town town;
    return "lat=" + std::to_string(town.place.lat_deg) + "&lon=" + std::to_string(town.place.lon_deg);
  }

  std::string raw(const std::string& request, bool finish = true) const {
    RawConnection connection(service->port());
    connection.send(request);
    if (finish) connection.finish();
    return connection.read_all();
  }

  inline static testing::TemporaryFolder* folder = nullptr;
  inline static testing::ServiceProcess* service = nullptr;
  httplib::Client client_ = testing::client_of(*service);
  const std::string fix_ = "/v1/maps/town/fix";
  const std::string fix_near_ = fix_ + "?" + here() + "&radius_m=200";  // in little enough ground
  const std::string match_ = "/v1/maps/town/match";
};

TEST_F(BadRequests, NameTheParameterThatIsWrong) {
  const std::string window = "/v1/maps/town/window?lat=57.7&lon=22.7&width_m=100&height_m=100";
  const std::pair<std::string, const char*> cases[] = {
      {"/v1/maps/town/window", "400 missing-parameter lat"},
      {window + "&cell_m=nan", "400 bad-parameter cell_m"},
      {window + "&cell_m=-2", "400 parameter-out-of-range cell_m"},
      {window + "&heading=3", "400 unknown-parameter heading"},
      {window + "&lat=3", "400 duplicate-parameter lat"},
      {window + "&format=bmp", "400 bad-parameter format"},
      {window + "&cell_m=0.001", "413 too-many-cells"},
      {"/v1/maps/town/window?lat=57&lon=22.7&width_m=100&height_m=100", "422 window-outside-map"},
      {"/v1/maps/town/window?lat=0&lon=-90&width_m=100&height_m=100", "422 position-outside-zone"},
      {"/v1/maps/town/window?lat=91&lon=0&width_m=100&height_m=100", "400 parameter-out-of-range lat"},
      {"/v1/maps/town/window?lat=89&lon=22.7&width_m=1e5&height_m=1e5", "413 too-many-cells"},
      {"/v1/maps/nowhere", "404 map-not-found"},
      {"/v1/maps/..%2f..%2fetc%2fpasswd", "404 map-not-found"},
      {"/v1/nothing", "404 route-not-found"},
      {"/v1/maps/%zz", "400 bad-url"},
  };
  for (const auto& [path, expected] : cases) EXPECT_EQ(refusal(client_.Get(path)), expected) << path;
}

TEST_F(BadRequests, SayWhichMethodsThereAre) {
  const auto answer = client_.Delete("/v1/maps/town");
  EXPECT_EQ(refusal(answer), "405 method-not-allowed");
  EXPECT_EQ(answer->get_header_value("Allow"), "GET, HEAD, OPTIONS");
  EXPECT_EQ(refusal(testing::client_of(*service).Put("/v1/maps/town", "body", "text/plain")), "405 method-not-allowed");
}

TEST_F(BadRequests, WithFeatureMapsThatCannotBeUsed) {
  const std::string png = testing::text_of(encode_feature_map(CellArray(64, 64, kNoRoad)));
  EXPECT_EQ(refusal(client_.Post(fix_ + "?cell_m=2", png, "text/plain")), "415 unsupported-media-type Content-Type");
  EXPECT_EQ(refusal(client_.Post(fix_near_, png, "image/png")), "400 missing-parameter cell_m");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&cell_m=2", "", "image/png")), "400 missing-parameter image");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&cell_m=2", "not a picture", "image/png")), "422 image-format");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&cell_m=2", png.substr(0, png.size() / 2), "image/png")),
            "422 image-damaged");
  EXPECT_EQ(refusal(client_.Post(fix_ + "?cell_m=2&lat=57.7", png, "image/png")), "400 missing-parameter lon");
  EXPECT_EQ(refusal(client_.Post(fix_ + "?cell_m=2&bbox=1,2,3", png, "image/png")), "400 bad-parameter bbox");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&cell_m=2&gsd_m=1", png, "image/png")), "400 bad-parameter gsd_m");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&kind=frame&gsd_m=1&nadir_col=3", png, "image/png")),
            "400 bad-parameter nadir_col");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&kind=frame&gsd_m=20", png, "image/png")),
            "400 parameter-out-of-range gsd_m");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&kind=frame&gsd_m=1e-4", png, "image/png")),
            "400 parameter-out-of-range gsd_m");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&kind=frame", png, "image/png")), "400 missing-parameter fov_deg");
  const std::string camera = fix_near_ + "&kind=frame&agl_m=50&focal_px=64";
  EXPECT_EQ(refusal(client_.Post(camera + "&distortion=0.1", png, "image/png")), "400 bad-parameter distortion");
  EXPECT_EQ(refusal(client_.Post(camera + "&lens=fisheye", png, "image/png")), "422 frame-camera");
  EXPECT_EQ(refusal(client_.Post(camera + "&principal_px=64,64", png, "image/png")), "422 frame-camera");
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&kind=frame&gsd_m=1&lens=fisheye", png, "image/png")),
            "400 bad-parameter lens");
  EXPECT_EQ(refusal(client_.Post(fix_ + "?cell_m=2", png, "image/png")), "413 search-area-too-large");
}

TEST_F(BadRequests, ForATrackThatWouldHaveToBeSearchedForOnTooMuchGroundAreTooLarge) {
  EXPECT_EQ(refusal(client_.Post("/v1/tracks", R"({"map":"town"})", "application/json")), "413 search-area-too-large");
}

TEST_F(BadRequests, WithAFrameOfMoreGroundThanADetectorCanLookAtAreTooLarge) {
  const std::string frame = testing::text_of(encode_feature_map(CellArray(500, 500, kNoRoad)));
  EXPECT_EQ(refusal(client_.Post("/v1/detect?gsd_m=5&cell_m=20", frame, "image/png")), "413 ground-too-large");
  EXPECT_EQ(refusal(client_.Post("/v1/detect?gsd_m=0.5&cell_m=0.2", frame, "image/png")), "413 too-many-cells");
  EXPECT_EQ(refusal(client_.Post("/v1/detect?fov_deg=150&agl_m=300&cell_m=20", frame, "image/png")),
            "413 ground-too-large");
}

TEST_F(BadRequests, WithNumbersBeyondAllSenseNameThem) {
  const std::string png = testing::text_of(encode_feature_map(CellArray(64, 64, kNoRoad)));
  for (const std::string field : {"time_us", "time_limit_s", "proof_s", "radius_m", "nadir_col", "max_modes"}) {
    const std::string prior = here() + (field == "radius_m" ? "&" : "&radius_m=9&");
    EXPECT_EQ(refusal(client_.Post(fix_ + "?cell_m=2&" + prior + field + "=1e300", png, "image/png")),
              "400 parameter-out-of-range " + field);
  }
  EXPECT_EQ(refusal(client_.Post(fix_ + "?cell_m=2&time_us=1.5", png, "image/png")), "400 bad-parameter time_us");
}

TEST_F(BadRequests, WithAConstantOrUnobservedFeatureMapGetNoFix) {
  for (const auto& [fill, reason] :
       {std::pair{kNoRoad, "too-few-roads"}, {kRoad, "too-few-roads"}, {kUnobserved, "footprint-unobserved"}}) {
    const auto answer = testing::json_of(client_.Post(
        fix_near_ + "&cell_m=2", testing::text_of(encode_feature_map(CellArray(64, 64, fill))), "image/png"));
    EXPECT_EQ(answer["status"], "no_fix");
    EXPECT_EQ(answer["reason"], reason);
  }
}

TEST_F(BadRequests, WithAPngBombAreRefusedByItsHeader) {
  // 60000 x 60000 pixels in a header and nothing behind it.
  const std::string bomb("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xea\x60\0\0\xea\x60\x08\x06\0\0\0\0\0\0\0", 33);
  EXPECT_EQ(refusal(client_.Post(fix_near_ + "&cell_m=2", bomb, "image/png")), "413 image-too-large");
  EXPECT_EQ(refusal(client_.Post("/v1/detect?gsd_m=1", bomb, "image/png")), "413 image-too-large");
}

TEST_F(BadRequests, WithBrokenJsonSayWhere) {
  const auto post = [&](const std::string& body) { return refusal(client_.Post(match_, body, "application/json")); };
  const std::string map = R"("cell_m":2,"cols":2,"rows":1,"cells":"AP4=")";
  EXPECT_EQ(post("{"), "400 bad-json body");
  EXPECT_EQ(post("[]"), "400 bad-json body");
  EXPECT_EQ(post(std::string(100'000, '[')), "400 json-too-deep body");
  EXPECT_EQ(post("{" + map + R"(,"poses":NaN})"), "400 bad-json body");
  EXPECT_EQ(post("{" + map + R"(,"poses":[]})"), "400 bad-parameter poses");
  EXPECT_EQ(post("{" + map + R"(,"poses":[{"lat":1,"lon":2}]})"), "400 missing-parameter poses[0].heading_deg");
  EXPECT_EQ(post("{" + map + R"(,"poses":[{"lat":1,"lon":2,"heading_deg":3},{"lat":"x","lon":2,"heading_deg":3}]})"),
            "400 bad-parameter poses[1].lat");
  EXPECT_EQ(post("{" + map + R"(,"poses":[{"lat":91,"lon":2,"heading_deg":3}]})"),
            "400 parameter-out-of-range poses[0].lat")
      << "as for a latitude anywhere else";
  EXPECT_EQ(post("{" + map + R"(,"pose_list":[]})"), "400 unknown-field pose_list");
  EXPECT_EQ(post(R"({"cell_m":2,"cols":2,"rows":2,"cells":"AP4=","poses":[{"lat":1,"lon":2,"heading_deg":3}]})"),
            "400 bad-parameter cells");
  EXPECT_EQ(post(R"({"cell_m":2,"cols":-2,"rows":2,"cells":"AP4=","poses":[{"lat":1,"lon":2,"heading_deg":3}]})"),
            "400 parameter-out-of-range cols");
  EXPECT_EQ(
      post(
          R"({"cell_m":2,"cols":16000000,"rows":16000000,"cells":"AP4=","poses":[{"lat":1,"lon":2,"heading_deg":3}]})"),
      "413 too-many-cells");
  EXPECT_EQ(post(R"({"cell_m":2,"image":"a!","poses":[{"lat":1,"lon":2,"heading_deg":3}]})"), "400 bad-base64 image");
}

TEST_F(BadRequests, WithTooManyPosesAreRefused) {
  std::string body = R"({"cell_m":2,"cols":2,"rows":1,"cells":"AP4=","poses":[{"lat":1,"lon":2,"heading_deg":3})";
  for (int i = 0; i < 1000; ++i) body += R"(,{"lat":1,"lon":2,"heading_deg":3})";
  EXPECT_EQ(refusal(client_.Post(match_, body + "]}", "application/json")), "413 too-many-poses");
  std::string many = R"({"poses":[0)";
  for (int i = 0; i < 300'000; ++i) many += ",0";
  EXPECT_EQ(refusal(client_.Post(match_, many + "]}", "application/json")), "413 json-too-long");
}

TEST_F(BadRequests, WithBodiesBeyondTheLimitAreRefusedHoweverTheyCome) {
  const std::string large(2 << 20, 'x');
  EXPECT_EQ(refusal(client_.Post(fix_ + "?cell_m=2", large, "image/png")), "413 body-too-large");
  EXPECT_EQ(refusal(testing::client_of(*service).Post(
                fix_ + "?cell_m=2",
                [&](std::size_t offset, httplib::DataSink& sink) {
                  if (offset < large.size())
                    sink.write(large.data(), 65536);
                  else
                    sink.done();
                  return true;
                },
                "image/png")),
            "413 body-too-large")
      << "chunked";
  EXPECT_THAT(raw("POST " + fix_ +
                  "?cell_m=2 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999999999999999\r\n\r\nabc"),
              HasSubstr("body-too-large"));
}

std::string gzipped(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(compressBound(text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

TEST_F(BadRequests, WithAGzipBombAreRefusedAtTheLimit) {
  const std::string bomb = gzipped(std::string(64 << 20, '\0'));
  ASSERT_LT(bomb.size(), 200'000U);
  EXPECT_EQ(refusal(client_.Post(fix_ + "?cell_m=2", {{"Content-Encoding", "gzip"}}, bomb, "image/png")),
            "413 body-too-large");
  EXPECT_EQ(refusal(testing::client_of(*service).Post(match_, {{"Content-Encoding", "gzip"}}, gzipped("{"),
                                                      "application/json")),
            "400 bad-json body");
  EXPECT_EQ(
      refusal(testing::client_of(*service).Post(match_, {{"Content-Encoding", "gzip"}}, "no gzip", "application/json")),
      "400 bad-body-encoding");
  EXPECT_EQ(refusal(testing::client_of(*service).Post(match_, {{"Content-Encoding", "br"}}, "x", "application/json")),
            "415 unsupported-content-encoding Content-Encoding");
}

TEST_F(BadRequests, WithABodyCutOffAreToldSo) {
  const std::string head = "POST " + fix_ + "?cell_m=2 HTTP/1.1\r\nHost: localhost\r\nContent-Type: image/png\r\n";
  EXPECT_THAT(raw(head + "Content-Length: 1000\r\n\r\nabc"), HasSubstr("body-cut-off"));
  EXPECT_THAT(raw(head + "\r\n"), AllOf(StartsWith("HTTP/1.1 411"), HasSubstr("length-required")));
  EXPECT_THAT(raw(head + "Content-Length: 3x\r\n\r\nabc"), HasSubstr("bad-content-length"));
  EXPECT_THAT(raw(head + "Content-Length: 3\r\nTransfer-Encoding: chunked\r\n\r\nabc"),
              HasSubstr("bad-content-length"));
  EXPECT_THAT(raw(head + "Transfer-Encoding: chunked\r\n\r\nzz\r\nabc"), HasSubstr("HTTP/1.1 400"));
}

TEST_F(BadRequests, WithALongHeaderAreToldHowLongItMayBe) {
  EXPECT_THAT(raw("GET /healthz HTTP/1.1\r\nHost: localhost\r\nCookie: " + std::string(9000, 'x') + "\r\n\r\n"),
              AllOf(HasSubstr("bad-request"), HasSubstr("headers of at most 8192 bytes each")));
}

TEST_F(BadRequests, ThatAreNotHttpGetAProblemAndTheDoor) {
  EXPECT_THAT(raw("hello\r\n\r\n"), AllOf(StartsWith("HTTP/1.1 400"), HasSubstr("problem+json")));
  EXPECT_THAT(raw("GET / HTTP/9.9\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(raw("BREW /coffee HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(raw("GET /" + std::string(6000, 'x') + " HTTP/1.1\r\nHost: localhost\r\n\r\n"),
              StartsWith("HTTP/1.1 414"));
  std::string large = "GET / HTTP/1.1\r\n";
  while (large.size() < 200'000) large += "X: " + std::string(8000, 'x') + "\r\n";
  EXPECT_THAT(raw(large + "\r\n"), AllOf(StartsWith("HTTP/1.1 431"), HasSubstr("head-too-large")));
  EXPECT_EQ(raw(""), "");
}

TEST_F(BadRequests, WithAnUnreadBodyDoNotBecomeTheNextRequest) {
  const std::string smuggled = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const std::string answer =
      raw("DELETE /v1/maps HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(smuggled.size()) +
              "\r\n\r\n" + smuggled,
          false);
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 405"));
  EXPECT_EQ(answer.find("HTTP/1.1", 1), std::string::npos) << answer;
}

}  // namespace
}  // namespace roadfix
