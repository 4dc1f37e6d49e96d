#include "server/http/gunzip.hpp"

#include <gmock/gmock.h>

#include "tests/server/http/server_fixture.hpp"

namespace roadfix::http {
namespace {

std::string gzipped(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

/// nullopt where it is damaged or not whole.
std::optional<std::string> unpacked(const std::string& packed, std::size_t piece) {
  Gunzip gunzip;
  std::string text;
  const auto take = [&](const char* data, std::size_t size) {
    text.append(data, size);
    return true;
  };
  for (std::size_t at = 0; at < packed.size(); at += piece) {
    if (!gunzip.unpack(packed.substr(at, piece), take)) return std::nullopt;
  }
  return gunzip.is_whole() ? std::optional(text) : std::nullopt;
}

TEST(Gunzip, UnpacksMembersOneAfterTheOther) {
  const std::string zeros(100'000, '\0');
  for (const std::size_t piece : {1UL, 7UL, 1000UL}) {
    EXPECT_EQ(unpacked("", piece), "");
    EXPECT_EQ(unpacked(gzipped("abc") + gzipped("") + gzipped("de"), piece), "abcde");
    EXPECT_EQ(unpacked(gzipped(zeros) + gzipped(zeros), piece), zeros + zeros);
  }
}

TEST(Gunzip, TakesNoStreamForWholeThatIsCutOff) {
  const std::string packed = gzipped("roads");
  for (std::size_t bytes = 1; bytes < packed.size(); ++bytes) {
    EXPECT_FALSE(unpacked(packed.substr(0, bytes), 1000)) << bytes;
    EXPECT_FALSE(unpacked(packed + packed.substr(0, bytes), 1000)) << "of the second member " << bytes;
  }
}

TEST(Gunzip, NoticesWhatIsDamagedOrNoGzip) {
  const std::string packed = gzipped("roads");
  std::string wrong_checksum = packed;
  ++wrong_checksum[packed.size() - 8];
  for (const std::string& stream : {wrong_checksum, packed + "x", std::string("roads"), packed.substr(10)}) {
    EXPECT_FALSE(unpacked(stream, 1000));
  }
}

class HttpServerPackedBodies : public testing::HttpServerTest {
 protected:
  std::string answer_to(const std::string& coding, const std::string& body) const {
    return client().Post("/length", httplib::Headers{{"Content-Encoding", coding}}, body, "text/plain")->body;
  }
};

TEST_F(HttpServerPackedBodies, AreUnpackedWhateverTheCaseAndUnderTheOldName) {
  const auto server = started();
  for (const char* coding : {"gzip", "GZIP", "x-gzip", "X-Gzip"}) {
    EXPECT_EQ(answer_to(coding, gzipped("abc") + gzipped("de")), "5") << coding;
  }
  EXPECT_EQ(answer_to("gzip, gzip", gzipped(gzipped("abc"))), "unsupported-content-encoding");
}

TEST_F(HttpServerPackedBodies, AreRefusedWithoutTheirChecksum) {
  const auto server = started();
  const std::string packed = gzipped("roads");
  for (const std::size_t lost : {1UL, 4UL, 8UL, 12UL}) {
    EXPECT_EQ(answer_to("gzip", packed.substr(0, packed.size() - lost)), "bad-body-encoding") << lost;
  }
}

}  // namespace
}  // namespace roadfix::http
