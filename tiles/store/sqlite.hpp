// SQLite as values: a connection, a prepared statement, a transaction that rolls back unless committed.
// Failures throw what the kind of file makes of them: to who uses it, a map and a store of tracks are different things.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace roadfix::sqlite {

enum class Access { kRead, kReadWrite, kCreate };

/// How long a person would rather wait than repeat a command.
inline constexpr std::chrono::milliseconds kPatience = std::chrono::minutes(2);

/// Why SQLite refused.
enum class Failure {
  kNeedsRecovery,  ///< a killed writer left a journal, which kRead may not roll back
  kNotADatabase,
  kDamaged,
  kOtherTables,  ///< a statement does not fit the tables of the file
  kBusy,         ///< another process has locked the file
  kNotWritable,
  kMoved,  ///< it cannot be written to, since the file is no longer where it was opened
  kFull,
  kOther,
};

/// The error of core/units/error.hpp to throw for a failure of one kind of file; `detail` is SQLite's message.
using ErrorOf =
    std::function<std::exception_ptr(const std::filesystem::path& file, Failure failure, const std::string& detail)>;

class Connection {
 public:
  /// Not to be used from two threads at once. Waits as long as `patience` for locks of other processes, each time. This
  /// and all that uses the connection throws what `error_of` returns.
  Connection(const std::filesystem::path& path, Access access, ErrorOf error_of,
             std::chrono::milliseconds patience = kPatience);

  const std::filesystem::path& path() const { return path_; }
  /// Runs statements that return nothing of interest.
  void execute(const char* sql);
  std::int64_t last_insert_id() const;
  /// Bytes that the file lacks according to its own header; 0 for a whole file. Reads through SQLite's descriptor:
  /// closing another one would drop the locks of every connection of this process.
  std::int64_t missing_bytes() const;
  /// Whether the file keeps a write-ahead log, for which even a reader makes files beside it. Reads as missing_bytes().
  bool in_wal_mode() const;
  sqlite3* handle() const { return handle_.get(); }
  /// Throws what the failure of a call with this result code means.
  [[noreturn]] void fail(int code, const std::string& detail) const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::filesystem::path path_;
  ErrorOf error_of_;
  std::unique_ptr<sqlite3, Close> handle_;
};

class Statement {
 public:
  /// The text must be one statement; the connection must outlive it.
  Statement(Connection& connection, std::string_view sql);

  /// Starts anew with these values for ?1, ?2, ...; texts and blobs must live until the last step.
  template <typename... Values>
  Statement& with(const Values&... values) {
    reset();
    int index = 0;
    (bind(++index, values), ...);
    return *this;
  }
  /// True while there is a row.
  bool step();
  /// Runs to the end.
  void run() {
    while (step()) {
    }
    reset();
  }
  /// Lets go of its locks; called by with() and by step() at the end.
  void reset();

  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  /// Valid until the next step.
  std::span<const std::byte> blob(int column) const;

 private:
  void bind(int index, std::int64_t value);
  void bind(int index, int value) { bind(index, std::int64_t{value}); }
  void bind(int index, bool value) { bind(index, std::int64_t{value}); }
  void bind(int index, double value);
  void bind(int index, std::string_view value);
  void bind(int index, const std::string& value) { bind(index, std::string_view(value)); }
  void bind(int index, const char* value) { bind(index, std::string_view(value)); }
  void bind(int index, std::span<const std::byte> value);
  void check(int code) const;

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Connection* connection_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

/// Removes what SQLite keeps beside the database of this name (-journal, -wal, -shm), where it is there. Of a database
/// that is gone it would be played back into the next one that gets the name.
void remove_logs(const std::filesystem::path& database);

/// What a query answers that asks for one number.
std::int64_t number(Connection& connection, std::string_view query);

/// Resets a statement that is kept at the end of a block: one left in the middle of its rows holds a lock on the file.
class ResetAtEnd {
 public:
  explicit ResetAtEnd(Statement& statement) : statement_(statement) {}
  ~ResetAtEnd() { statement_.reset(); }
  ResetAtEnd(const ResetAtEnd&) = delete;
  ResetAtEnd& operator=(const ResetAtEnd&) = delete;

 private:
  Statement& statement_;
};

class Transaction {
 public:
  /// kWrite takes the write lock at once; kRead keeps one consistent view of the file.
  enum class Kind { kRead, kWrite };
  Transaction(Connection& connection, Kind kind);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Connection& connection_;
  bool open_ = true;
};

}  // namespace roadfix::sqlite
