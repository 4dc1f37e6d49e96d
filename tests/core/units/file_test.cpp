#include "core/units/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/units/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ReadFile, GivesEveryByte) {
  const testing::TemporaryFolder folder;
  const std::string bytes("a\r\n\0\xff b", 7);
  std::ofstream(folder / "file", std::ios::binary) << bytes;
  EXPECT_EQ(read_file(folder / "file"), bytes);
  std::ofstream(folder / "empty").flush();
  EXPECT_EQ(read_file(folder / "empty"), "");
}

TEST(ReadFile, GivesLargeFilesWhole) {
  const testing::TemporaryFolder folder;
  for (const std::size_t size : {std::size_t{1} << 20U, (std::size_t{5} << 19U) + 3}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 2654435761U >> 13U);
    std::ofstream(folder / "file", std::ios::binary) << bytes;
    EXPECT_TRUE(read_file(folder / "file") == bytes) << size;
  }
}

TEST(ReadFile, GivesNothingOfAFolderAndOfWhatIsNotThere) {
  const testing::TemporaryFolder folder;
  EXPECT_EQ(read_file(folder.path()), std::nullopt);
  EXPECT_EQ(read_file(folder / "none"), std::nullopt);
}

TEST(ReadNamedFile, TellsWhyAFileCannotBeRead) {
  const testing::TemporaryFolder folder;
  const auto refusal = [](const std::filesystem::path& file) {
    try {
      read_named_file(file);
    } catch (const NotFound& error) {
      return error.code() + ": " + error.what();
    }
    return std::string("none");
  };
  EXPECT_THAT(refusal(folder / "none"), AllOf(StartsWith("file-not-found: " + (folder / "none").string()),
                                              HasSubstr("No such file"), HasSubstr("check its name")));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("directory"));
  std::ofstream(folder / "file") << "bytes";
  EXPECT_EQ(read_named_file(folder / "file"), "bytes");
}

}  // namespace
}  // namespace roadfix
