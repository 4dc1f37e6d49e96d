#include "tiles/store/sqlite.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <system_error>
#include "core/units/bytes.hpp"

namespace roadfix::sqlite {
namespace {

Failure failure_of(int code) {
  if (code == SQLITE_READONLY_ROLLBACK) return Failure::kNeedsRecovery;
  if (code == SQLITE_READONLY_DBMOVED) return Failure::kMoved;
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      return Failure::kNotADatabase;
    case SQLITE_CORRUPT:
      return Failure::kDamaged;
    case SQLITE_ERROR:
      return Failure::kOtherTables;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return Failure::kBusy;
    case SQLITE_READONLY:
      return Failure::kNotWritable;
    case SQLITE_FULL:
      return Failure::kFull;
    default:
      return Failure::kOther;
  }
}

/// The header of "Database File Format", https://www.sqlite.org/fileformat2.html#the_database_header
using Header = std::array<unsigned char, 100>;

/// The database file as SQLite holds it open; nullptr where it does not.
sqlite3_file* file_of(sqlite3* handle) {
  sqlite3_file* file = nullptr;
  const int code = sqlite3_file_control(handle, "main", SQLITE_FCNTL_FILE_POINTER, static_cast<void*>(&file));
  return code == SQLITE_OK && file->pMethods != nullptr ? file : nullptr;
}

std::optional<Header> header_of(sqlite3_file* file) {
  Header header{};
  if (file->pMethods->xRead(file, header.data(), static_cast<int>(header.size()), 0) != SQLITE_OK) return {};
  return header;
}

/// What the operating system said: SQLite itself does not pass that on where a commit fails.
int system_error(sqlite3* handle) {
  int reason = sqlite3_system_errno(handle);
  if (reason == 0) sqlite3_file_control(handle, "main", SQLITE_FCNTL_LAST_ERRNO, &reason);
  return reason;
}

/// SQLite's message, and what the operating system said where that refused to read or write.
std::string explained(sqlite3* handle, int code, const std::string& message) {
  const int reason = (code & 0xff) == SQLITE_IOERR ? system_error(handle) : 0;
  return reason == 0 ? message : message + ": " + std::system_category().message(reason);
}

}  // namespace

void Connection::Close::operator()(sqlite3* handle) const { sqlite3_close(handle); }

Connection::Connection(const std::filesystem::path& path, Access access, ErrorOf error_of,
                       std::chrono::milliseconds patience)
    : path_(path), error_of_(std::move(error_of)) {
  const int mode = access == Access::kRead        ? SQLITE_OPEN_READONLY
                   : access == Access::kReadWrite ? SQLITE_OPEN_READWRITE
                                                  : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, mode | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK) {
    const int reason = handle == nullptr ? 0 : sqlite3_system_errno(handle);
    fail(code, reason == 0 ? std::string(sqlite3_errstr(code)) : std::system_category().message(reason));
  }
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, static_cast<int>(patience.count()));
}

void Connection::fail(int code, const std::string& detail) const {
  if (code == SQLITE_NOMEM) throw std::bad_alloc();
  std::rethrow_exception(error_of_(path_, failure_of(code), explained(handle_.get(), code, detail)));
}

void Connection::execute(const char* sql) {
  const int code = sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code, sqlite3_errmsg(handle_.get()));
}

std::int64_t Connection::missing_bytes() const {
  sqlite3_file* const file = file_of(handle_.get());
  sqlite3_int64 size = 0;
  if (file == nullptr || file->pMethods->xFileSize(file, &size) != SQLITE_OK) return 0;
  constexpr auto kHeaderSize = static_cast<sqlite3_int64>(Header{}.size());
  if (size < kHeaderSize) return kHeaderSize - size;
  const auto header = header_of(file);
  if (!header) return 0;
  const Bytes bytes = *header;
  const std::int64_t page = big_endian(bytes.subspan(16, 2)) == 1 ? 65536 : big_endian(bytes.subspan(16, 2));
  return std::max<std::int64_t>(0, page * big_endian(bytes.subspan(28, 4)) - size);
}

bool Connection::in_wal_mode() const {
  sqlite3_file* const file = file_of(handle_.get());
  const auto header = file == nullptr ? std::nullopt : header_of(file);
  constexpr std::uint8_t kWal = 2;
  return header && header->at(19) == kWal;
}

std::int64_t Connection::last_insert_id() const { return sqlite3_last_insert_rowid(handle_.get()); }

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(Connection& connection, std::string_view sql) : connection_(&connection) {
  sqlite3_stmt* handle = nullptr;
  check(sqlite3_prepare_v3(connection.handle(), sql.data(), static_cast<int>(sql.size()), SQLITE_PREPARE_PERSISTENT,
                           &handle, nullptr));
  handle_.reset(handle);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) connection_->fail(code, sqlite3_errmsg(connection_->handle()));
}

bool Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    const std::string detail = sqlite3_errmsg(connection_->handle());
    sqlite3_reset(handle_.get());
    connection_->fail(code, detail);
  }
  reset();
  return false;
}

void Statement::reset() { sqlite3_reset(handle_.get()); }

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(handle_.get(), column); }
double Statement::real(int column) const { return sqlite3_column_double(handle_.get(), column); }

std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return text == nullptr ? std::string()
                         : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column)));
}

std::span<const std::byte> Statement::blob(int column) const {
  const void* data = sqlite3_column_blob(handle_.get(), column);
  return {static_cast<const std::byte*>(data),
          data == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

void Statement::bind(int index, std::int64_t value) { check(sqlite3_bind_int64(handle_.get(), index, value)); }
void Statement::bind(int index, double value) { check(sqlite3_bind_double(handle_.get(), index, value)); }

void Statement::bind(int index, std::string_view value) {
  const char* data = value.data() == nullptr ? "" : value.data();
  check(sqlite3_bind_text64(handle_.get(), index, data, value.size(), SQLITE_STATIC, SQLITE_UTF8));
}

void Statement::bind(int index, std::span<const std::byte> value) {
  check(sqlite3_bind_blob64(handle_.get(), index, value.data(), value.size(), SQLITE_STATIC));
}

std::int64_t number(Connection& connection, std::string_view query) {
  Statement statement(connection, query);
  statement.step();
  return statement.integer(0);
}

void remove_logs(const std::filesystem::path& database) {
  std::error_code ignored;
  for (const char* log : {"-journal", "-wal", "-shm"}) std::filesystem::remove(database.string() + log, ignored);
}

Transaction::Transaction(Connection& connection, Kind kind) : connection_(connection) {
  connection_.execute(kind == Kind::kWrite ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
  // A failed rollback leaves nothing to undo: SQLite rolls the journal back at the next open.
  if (open_) sqlite3_exec(connection_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  connection_.execute("COMMIT");
  open_ = false;
}

}  // namespace roadfix::sqlite
