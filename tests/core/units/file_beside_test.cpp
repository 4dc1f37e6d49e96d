#include "core/units/file_beside.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <string>

#include "core/units/file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

TEST(FileBeside, TakesThePlaceOfItsTargetWhenItIsFinished) {
  const testing::TemporaryFolder folder;
  write(folder / "a.txt", "before");
  FileBeside file(folder / "a.txt");
  write(file.unfinished(), "after");
  EXPECT_EQ(read_file(folder / "a.txt"), "before");
  file.finish();
  EXPECT_EQ(read_file(folder / "a.txt"), "after");
  EXPECT_FALSE(fs::exists(file.unfinished()));
}

TEST(FileBeside, LeavesNothingWhereItIsNotFinished) {
  const testing::TemporaryFolder folder;
  std::optional<FileBeside> file(folder / "a.txt");
  write(file->unfinished(), "half");
  file.reset();
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(FileBeside, LeavesTheTargetAsItIsWhereItCannotTakeItsPlace) {
  const testing::TemporaryFolder folder;
  EXPECT_THROW(FileBeside(folder / "a.txt").finish(), fs::filesystem_error) << "which nobody wrote";
  fs::create_directories(folder / "b.txt" / "inside");
  {
    FileBeside file(folder / "b.txt");
    write(file.unfinished(), "whole");
    EXPECT_THROW(file.finish(), fs::filesystem_error);
  }
  EXPECT_TRUE(fs::exists(folder / "b.txt" / "inside"));
  fs::remove_all(folder / "b.txt");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(FileBeside, SharesItsNameWithNoOtherAndEndsLikeItsTarget) {
  const FileBeside one("a.tif");
  const FileBeside two("a.tif");
  EXPECT_NE(one.unfinished(), two.unfinished());
  EXPECT_EQ(one.unfinished().extension(), ".tif");
}

TEST(FileBeside, RemovesWhatWasLeftUnderANameOfItsOwn) {
  const testing::TemporaryFolder folder;
  write(folder / "a-new", "of a process that was killed");
  const FileBeside file(folder / "a", folder / "a-new");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace roadfix
