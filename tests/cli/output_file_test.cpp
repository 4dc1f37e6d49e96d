#include "cli/output_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::cli {
namespace {

using roadfix::testing::code_of;

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(OutputFile, HoldsTheBytesAndNothingOfTheFileBefore) {
  const roadfix::testing::TemporaryFolder folder;
  const auto file = folder.path() / "result.json";
  write_file(file, "longer than what follows");
  write_file(file, std::string("a\r\n\0b", 5));
  EXPECT_EQ(content_of(file), std::string("a\r\n\0b", 5));
}

TEST(OutputFile, IsRefusedWhereNotAllOfItCanBeWritten) {
  EXPECT_EQ(code_of([] { write_file("/nowhere/at/all.json", "{}"); }), "result-unwritable");
  EXPECT_EQ(code_of([] { write_file("/dev/full", "{}"); }), "result-unwritable");
}

TEST(OutputFile, IsLookedAtBeforehandAndLeftAsItIs) {
  const roadfix::testing::TemporaryFolder folder;
  const auto old = folder.path() / "old.json";
  write_file(old, "of last week");
  require_writable({old, folder.path() / "new.json", ""});
  EXPECT_EQ(content_of(old), "of last week");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "new.json"));
  EXPECT_EQ(code_of([&] { require_writable({old, "/nowhere/at/all.json"}); }), "result-unwritable");
}

TEST(OutputFile, IsNeitherWrittenOverWhatIsReadNorOverAnotherResult) {
  const roadfix::testing::TemporaryFolder folder;
  const auto map = folder.path() / "map.gpkg";
  write_file(map, "a map");
  std::filesystem::create_symlink(map, folder.path() / "link");
  const auto refusal = [&](const std::filesystem::path& a, const std::filesystem::path& b) {
    return code_of([&] { require_apart({a, b}, {map, ""}); });
  };
  const auto json = folder.path() / "out.json";
  EXPECT_EQ(refusal(json, folder.path() / "out.csv"), "no error");
  EXPECT_EQ(refusal("", ""), "no error");
  EXPECT_EQ(refusal("/dev/null", "/dev/null"), "no error");
  EXPECT_EQ(refusal(json, "-"), "target-is-dash");
  EXPECT_EQ(refusal(json, "./-"), "no error");
  EXPECT_EQ(refusal(json, folder.path() / "none" / ".." / "map.gpkg"), "target-is-source");
  EXPECT_EQ(refusal(folder.path() / "link", json), "target-is-source");
  EXPECT_EQ(refusal(json, folder.path() / "." / "out.json"), "target-given-twice");
}

}  // namespace
}  // namespace roadfix::cli
