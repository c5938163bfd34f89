// SPDX-License-Identifier: BSD-3-Clause
// The C interface of SQLite behind Database and Statement.
#include "database.h"

#include <sqlite3.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

// A reader may have to wait while a writer ends its transaction.
constexpr int kPatience_ms = 30000;

[[noreturn]] void failInDatabase(sqlite3* database, const std::string& name) {
  throw RunError(name + ": " + sqlite3_errmsg(database));
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, std::string_view sql, std::string name) : name_(std::move(name)) {
  sqlite3_stmt* handle = nullptr;
  if (sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &handle, nullptr) != SQLITE_OK)
    failInDatabase(database, name_);
  handle_.reset(handle);
  if (!handle) throw RunError(name_ + ": an empty statement");
}

bool Statement::step() {
  const int outcome = sqlite3_step(handle_.get());
  if (outcome == SQLITE_ROW) return true;
  if (outcome != SQLITE_DONE) failInDatabase(sqlite3_db_handle(handle_.get()), name_);
  return false;
}

void Statement::reset() {
  sqlite3_reset(handle_.get());
  sqlite3_clear_bindings(handle_.get());
}

std::optional<std::int64_t> Statement::firstInteger() {
  std::optional<std::int64_t> out;
  if (step()) out = integer(0);
  reset();
  return out;
}

int Statement::columns() const {
  return sqlite3_column_count(handle_.get());
}

std::string Statement::columnName(int column) const {
  return sqlite3_column_name(handle_.get(), column);
}

bool Statement::isNull(int column) const {
  return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
}

double Statement::number(int column) const {
  return sqlite3_column_double(handle_.get(), column);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

std::string Statement::text(int column) const {
  const auto* bytes = sqlite3_column_text(handle_.get(), column);
  return bytes ? std::string(reinterpret_cast<const char*>(bytes),
                             static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column)))
               : std::string();
}

void Statement::bindOne(int place, std::int64_t value) {
  sqlite3_bind_int64(handle_.get(), place, value);
}

void Statement::bindOne(int place, double value) {
  sqlite3_bind_double(handle_.get(), place, value);
}

void Statement::bindOne(int place, const std::string& value) {
  sqlite3_bind_text(handle_.get(), place, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
}

void Database::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

namespace {

// A catalogue that others write needs files beside it, also to be read. Where one may not make them and there are none, nobody writes now.
bool standsStill(const std::filesystem::path& file) {
  const auto folder = std::filesystem::absolute(file).parent_path();
  return access(folder.c_str(), W_OK) != 0 && !std::filesystem::exists(file.string() + "-wal");
}

std::string immutableUri(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    char encoded[4];
    std::snprintf(encoded, sizeof encoded, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    uri += std::isalnum(static_cast<unsigned char>(c)) || c == '/' ? std::string(1, c) : encoded;
  }
  return uri + "?immutable=1";
}

}  // namespace

Database::Database(const std::filesystem::path& file, Mode mode) : name_(file.string()) {
  const bool reading = mode == Mode::kReadOnly;
  if (reading && !std::filesystem::is_regular_file(file)) throw InputError(name_ + ": no such catalogue");
  sqlite3* handle = nullptr;
  const int flags = reading ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const bool immutable = reading && standsStill(file);
  const int outcome = sqlite3_open_v2((immutable ? immutableUri(file) : name_).c_str(), &handle, flags | (immutable ? SQLITE_OPEN_URI : 0), nullptr);
  handle_.reset(handle);
  if (outcome != SQLITE_OK) {
    const std::string problem = name_ + ": " + (handle ? sqlite3_errmsg(handle) : sqlite3_errstr(outcome));
    if (reading) throw InputError(problem);
    throw RunError(problem);
  }
  sqlite3_busy_timeout(handle, kPatience_ms);
}

void Database::execute(const std::string& sql) {
  if (sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    failInDatabase(handle_.get(), name_);
}

Statement Database::prepare(std::string_view sql) const {
  return {handle_.get(), sql, name_};
}

std::int64_t Database::lastId() const {
  return sqlite3_last_insert_rowid(handle_.get());
}

std::int64_t Database::integer(std::string_view sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const RunError&) {  // an error that ended the transaction by itself is already on its way
  }
}

void Transaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace roomgraph
