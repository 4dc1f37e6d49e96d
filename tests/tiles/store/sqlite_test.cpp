#include "tiles/store/sqlite.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <stdexcept>

#include "tests/support/room.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::sqlite {
namespace {

namespace fs = std::filesystem;

/// What a file of the test's own kind throws.
struct Refused {
  fs::path file;
  Failure failure;
};

std::exception_ptr refused(const fs::path& file, Failure failure, const std::string& /*detail*/) {
  return std::make_exception_ptr(Refused{file, failure});
}

class Sqlite : public ::testing::Test {
 protected:
  Sqlite() : path(folder / "file.sqlite") {
    Connection(path, Access::kCreate, refused).execute("CREATE TABLE t (v BLOB)");
  }

  template <typename Call>
  Failure failure_of(const Call& call) const {
    try {
      call();
    } catch (const Refused& refusal) {
      EXPECT_EQ(refusal.file, path);
      return refusal.failure;
    }
    ADD_FAILURE() << "no failure";
    return Failure::kOther;
  }

  /// Of opening the file and reading from it.
  Failure failure_to_read(const char* sql = "SELECT v FROM t") const {
    return failure_of([&] {
      Connection file(path, Access::kRead, refused);
      Statement(file, sql).run();
    });
  }

  testing::TemporaryFolder folder;
  fs::path path;
};

std::exception_ptr detail_of(const fs::path& /*file*/, Failure, const std::string& detail) {
  return std::make_exception_ptr(std::runtime_error(detail));
}

TEST(SqliteFile, SaysWhyItCannotBeOpened) {
  try {
    const Connection none("no/such/folder/file.sqlite", Access::kCreate, detail_of);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "No such file or directory");
  }
}

/// As on a memory card whose file system has no files of more than 4 GB, or where a quota is used up.
TEST(SqliteFile, SaysWhyItCannotBeWrittenTo) {
  const testing::TemporaryFolder folder;
  Connection file(folder / "file.sqlite", Access::kCreate, detail_of);
  file.execute("CREATE TABLE t (v BLOB)");
  const testing::Room room(20'000);
  try {
    file.execute("INSERT INTO t VALUES (zeroblob(50000))");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "disk I/O error: File too large");
  }
}

TEST_F(Sqlite, TheKindOfFileSaysWhatAFailureIs) {
  EXPECT_EQ(failure_to_read("SELECT v FROM another"), Failure::kOtherTables);
  EXPECT_EQ(failure_to_read("DELETE FROM t"), Failure::kNotWritable);
  std::ofstream(path, std::ios::trunc) << std::string(5000, 'x');
  EXPECT_EQ(failure_to_read(), Failure::kNotADatabase);
  fs::remove(path);
  EXPECT_EQ(failure_to_read(), Failure::kOther);
}

TEST_F(Sqlite, APageOfNoiseIsDamage) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(4096);
  file << std::string(4096, 'x');
  file.close();
  EXPECT_EQ(failure_to_read(), Failure::kDamaged);
}

TEST_F(Sqlite, AFileThatMayNotGrowIsFull) {
  Connection file(path, Access::kReadWrite, refused);
  file.execute("PRAGMA max_page_count = 3");
  EXPECT_EQ(failure_of([&] { file.execute("INSERT INTO t VALUES (zeroblob(100000))"); }), Failure::kFull);
}

TEST_F(Sqlite, AFileThatAnotherWritesIsBusy) {
  Connection writer(path, Access::kReadWrite, refused);
  const Transaction open(writer, Transaction::Kind::kWrite);
  Connection second(path, Access::kReadWrite, refused, std::chrono::milliseconds(0));
  EXPECT_EQ(failure_of([&] { second.execute("INSERT INTO t VALUES (1)"); }), Failure::kBusy);
}

}  // namespace
}  // namespace roadfix::sqlite
