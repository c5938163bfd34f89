// SPDX-License-Identifier: BSD-3-Clause
// SQLite database and prepared statements that close themselves; errors as exceptions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace roomgraph {

/// A prepared statement: bind what the question marks stand for, then step through the rows.
class Statement {
 public:
  Statement(sqlite3* database, std::string_view sql, std::string name);

  /// Values of the question marks, the first one first; the statement begins anew.
  template <class... Values>
  Statement& bind(const Values&... values) {
    reset();
    int place = 0;
    (bindOne(++place, values), ...);
    return *this;
  }
  /// To the next row; false after the last one. Throws RunError.
  bool step();
  /// For statements without rows. Throws RunError.
  void run() {
    while (step()) {
    }
    reset();
  }
  void reset();
  /// First column of the first row; nothing without rows. The statement is reset.
  std::optional<std::int64_t> firstInteger();

  int columns() const;
  std::string columnName(int column) const;
  bool isNull(int column) const;
  double number(int column) const;
  std::int64_t integer(int column) const;
  std::string text(int column) const;

  sqlite3_stmt* get() const { return handle_.get(); }

 private:
  void bindOne(int place, std::int64_t value);
  void bindOne(int place, int value) { bindOne(place, static_cast<std::int64_t>(value)); }
  void bindOne(int place, double value);
  void bindOne(int place, const std::string& value);
  template <class Value>
  void bindOne(int place, const std::optional<Value>& value) {
    if (value) bindOne(place, *value);
  }

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  std::string name_;
};

/// A connection to a database file.
class Database {
 public:
  enum class Mode { kReadOnly, kReadWrite };
  /// kReadWrite makes the file when it is not there. Throws InputError (kReadOnly) or RunError naming file
  /// and cause.
  Database(const std::filesystem::path& file, Mode mode);

  /// Statements without rows and values, separated by semicolons. Throws RunError.
  void execute(const std::string& sql);
  /// Throws RunError: the text is no SQL of this database.
  Statement prepare(std::string_view sql) const;
  std::int64_t lastId() const;
  /// First column of the first row; 0 without rows.
  std::int64_t integer(std::string_view sql) const;
  const std::string& name() const { return name_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::string name_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// Everything written while it exists is written at once by commit(), or not at all.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace roomgraph
