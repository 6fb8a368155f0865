#include "sqlite_file.hpp"

#include "vigia/core/error.hpp"

namespace vigia::evaluation {

SqliteFile::SqliteFile(std::filesystem::path path) : path_(std::move(path)) {
  sqlite3* database = nullptr;
  const int status = sqlite3_open(path_.c_str(), &database);
  database_.reset(database);
  check(status);
}

void SqliteFile::execute(const std::string& sql) {
  check(sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

void SqliteFile::close() {
  statement_.reset();
  check(sqlite3_close(database_.release()));
}

void SqliteFile::check(int status) const {
  if (status == SQLITE_OK || status == SQLITE_DONE) return;
  throw InputError("cannot write " + path_.string() + ": " + sqlite3_errstr(status));
}

void SqliteFile::prepare(const std::string& table, std::size_t columns) {
  if (statement_ && table_ == table) return;
  std::string sql = "INSERT INTO " + table + " VALUES (?";
  for (std::size_t i = 1; i < columns; ++i) sql += ",?";
  sqlite3_stmt* statement = nullptr;
  const int status =
      sqlite3_prepare_v2(database_.get(), (sql + ")").c_str(), -1, &statement, nullptr);
  statement_.reset(statement);
  table_ = table;
  check(status);
}

void SqliteFile::bind(int column, double value) {
  check(sqlite3_bind_double(statement_.get(), column, value));
}

void SqliteFile::bind(int column, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), column, value));
}

void SqliteFile::bind(int column, std::string_view value) {
  check(sqlite3_bind_text(statement_.get(), column, value.data(), static_cast<int>(value.size()),
                          SQLITE_TRANSIENT));
}

void SqliteFile::bind(int column, const std::optional<double>& value) {
  if (value) return bind(column, *value);
  check(sqlite3_bind_null(statement_.get(), column));
}

void SqliteFile::step() {
  check(sqlite3_step(statement_.get()));
  check(sqlite3_reset(statement_.get()));
}

}  // namespace vigia::evaluation
