#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <sqlite3.h>

namespace vigia::evaluation {

/// A SQLite file being made: every failure is an InputError that names the file.
class SqliteFile {
 public:
  explicit SqliteFile(std::filesystem::path path);

  void execute(const std::string& sql);
  /// Adds a row to @p table, a value for each of its columns.
  template <typename... Values>
  void insert(const std::string& table, const Values&... values) {
    prepare(table, sizeof...(values));
    int column = 0;
    (bind(++column, values), ...);
    step();
  }
  /// Writes what is left and closes.
  void close();

 private:
  void check(int status) const;
  void prepare(const std::string& table, std::size_t columns);
  void bind(int column, double value);
  void bind(int column, int value) { bind(column, static_cast<std::int64_t>(value)); }
  void bind(int column, std::int64_t value);
  void bind(int column, std::string_view value);
  void bind(int column, const std::optional<double>& value);
  void step();

  struct Closer {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  std::filesystem::path path_;
  std::unique_ptr<sqlite3, Closer> database_;
  std::unique_ptr<sqlite3_stmt, Closer> statement_;  ///< of the table that rows went into last
  std::string table_;
};

}  // namespace vigia::evaluation
