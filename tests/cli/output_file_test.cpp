#include "cli/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/code_of.hpp"
#include "tests/support/room.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::cli {
namespace {

using roadfix::testing::code_of;

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t files_in(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
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

TEST(OutputFile, IsAsBeforeWhereThereIsNoRoomForTheNewOne) {
  const roadfix::testing::TemporaryFolder folder;
  const auto file = folder.path() / "calibration.json";
  write_file(file, "of last week");
  {
    const roadfix::testing::Room room(100);
    EXPECT_EQ(code_of([&] { write_file(file, std::string(1000, 'x')); }), "result-unwritable");
    EXPECT_EQ(code_of([&] { write_file(folder.path() / "new.json", std::string(1000, 'x')); }), "result-unwritable");
  }
  EXPECT_EQ(content_of(file), "of last week");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(OutputFile, KeepsItsLinkAndItsPermissions) {
  namespace fs = std::filesystem;
  const roadfix::testing::TemporaryFolder folder;
  const auto file = folder.path() / "out.json";
  write_file(file, "before");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_directory(folder.path() / "results");
  fs::create_symlink("../out.json", folder.path() / "results" / "link");
  write_file(folder.path() / "results" / "link", "after");
  EXPECT_EQ(content_of(file), "after");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "results" / "link"));
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(OutputFile, GoesWhereItsLinkLeadsThoughNothingIsThereYet) {
  namespace fs = std::filesystem;
  const roadfix::testing::TemporaryFolder folder;
  const auto link = folder.path() / "link.json";
  fs::create_directory(folder.path() / "results");
  fs::create_symlink("results/out.json", link);
  require_writable({link});
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_FALSE(fs::exists(link)) << "what it leads to";
  write_file(link, "{}");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content_of(folder.path() / "results" / "out.json"), "{}");
}

TEST(OutputFile, IsWrittenInItsPlaceWhereItsFolderTakesNoOther) {
  const roadfix::testing::TemporaryFolder folder;
  const std::string longest(255, 'n');  // which leaves no room for a longer name beside it
  write_file(folder.path() / longest, "before");
  write_file(folder.path() / longest, "after");
  EXPECT_EQ(content_of(folder.path() / longest), "after");
}

TEST(OutputFile, GoesToWhatAProcessHasOpenAlready) {
  const roadfix::testing::TemporaryFolder folder;
  std::FILE* const open = std::fopen((folder.path() / "printed").c_str(), "w");
  write_file("/proc/self/fd/" + std::to_string(fileno(open)), "first,");
  std::fseek(open, 0, SEEK_END);
  std::fputs(" then", open);
  std::fclose(open);
  EXPECT_EQ(content_of(folder.path() / "printed"), "first, then");
}

TEST(OutputFile, IsReplacedUnlessItIsADeviceAPipeOrOpenAlready) {
  const roadfix::testing::TemporaryFolder folder;
  const auto file = folder.path() / "out.json";
  EXPECT_TRUE(is_replaced(file));
  write_file(file, "{}");
  EXPECT_TRUE(is_replaced(file));
  EXPECT_FALSE(is_replaced("/dev/null"));
  EXPECT_FALSE(is_replaced("/dev/stdout"));
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_FALSE(is_replaced(pipe));
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
