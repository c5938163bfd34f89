// SPDX-License-Identifier: BSD-3-Clause
// SQLite's C interface, read-only and bounded by the size of the file.
#include "roomgraph/datasets/sqlite_reader.h"

#include <sqlite3.h>

#include <algorithm>
#include <limits>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

// As a URI, in which some characters mean something.
std::string uriOf(const std::filesystem::path& file, const std::string& options) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string())
    uri += c == '%' ? "%25" : c == '?' ? "%3f" : c == '#' ? "%23" : std::string(1, c);
  return uri + "?" + options;
}

}  // namespace

struct SqliteReader::Impl {
  std::filesystem::path file;
  std::string complaint;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database{nullptr, sqlite3_close};
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> query{nullptr, sqlite3_finalize};

  int open(const std::string& options) {
    sqlite3* opened = nullptr;
    const int state = sqlite3_open_v2(uriOf(file, options).c_str(), &opened,
                                      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database.reset(opened);
    return state;
  }
};

SqliteReader::SqliteReader(const std::filesystem::path& file, std::string complaint)
    : impl_(new Impl{file, std::move(complaint)}) {
  if (impl_->open("mode=ro") != SQLITE_OK) fail();
  // A writer that was killed leaves a journal, which can be read only where its lock file may be made.
  if (sqlite3_exec(impl_->database.get(), "SELECT 1 FROM sqlite_master", nullptr, nullptr, nullptr) ==
          SQLITE_CANTOPEN &&
      impl_->open("immutable=1") != SQLITE_OK)
    fail();
  const auto size =
      std::min<std::uintmax_t>(std::filesystem::file_size(file), std::numeric_limits<int>::max());
  sqlite3_limit(impl_->database.get(), SQLITE_LIMIT_LENGTH, static_cast<int>(size));
}

SqliteReader::~SqliteReader() = default;

void SqliteReader::ask(const std::string& sql) {
  sqlite3_stmt* query = nullptr;
  if (sqlite3_prepare_v2(impl_->database.get(), sql.c_str(), -1, &query, nullptr) != SQLITE_OK) fail();
  impl_->query.reset(query);
}

SqliteReader::Step SqliteReader::step() {
  const int state = sqlite3_step(impl_->query.get());
  return state == SQLITE_ROW ? Step::kRow : state == SQLITE_DONE ? Step::kDone : Step::kFailed;
}

bool SqliteReader::isNull(int column) const {
  return sqlite3_column_type(impl_->query.get(), column) == SQLITE_NULL;
}

std::int64_t SqliteReader::integer(int column) const {
  return sqlite3_column_int64(impl_->query.get(), column);
}

double SqliteReader::real(int column) const {
  return sqlite3_column_double(impl_->query.get(), column);
}

std::string SqliteReader::text(int column) const {
  const auto* begin = sqlite3_column_text(impl_->query.get(), column);
  return begin ? reinterpret_cast<const char*>(begin) : "";
}

std::span<const std::uint8_t> SqliteReader::blob(int column) const {
  const auto* begin = static_cast<const std::uint8_t*>(sqlite3_column_blob(impl_->query.get(), column));
  return {begin, begin ? static_cast<std::size_t>(sqlite3_column_bytes(impl_->query.get(), column)) : 0};
}

std::string SqliteReader::cause() const {
  return sqlite3_errmsg(impl_->database.get());
}

void SqliteReader::fail() const {
  throw InputError(impl_->file.string() + ": " + impl_->complaint + ": " + cause());
}

}  // namespace roomgraph
