#include "core/units/file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

TEST(ReadFile, GivesEveryByte) {
  const testing::TemporaryFolder folder;
  const std::string bytes("a\r\n\0\xff b", 7);
  std::ofstream(folder / "file", std::ios::binary) << bytes;
  EXPECT_EQ(read_file(folder / "file"), bytes);
  std::ofstream(folder / "empty").flush();
  EXPECT_EQ(read_file(folder / "empty"), "");
}

TEST(ReadFile, GivesNothingOfAFolderAndOfWhatIsNotThere) {
  const testing::TemporaryFolder folder;
  EXPECT_EQ(read_file(folder.path()), std::nullopt);
  EXPECT_EQ(read_file(folder / "none"), std::nullopt);
}

}  // namespace
}  // namespace roadfix
