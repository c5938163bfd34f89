// SPDX-License-Identifier: BSD-3-Clause
// A user's own SELECT, as texts.
#include <sqlite3.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "catalogue_impl.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

// As short as may be without a digit lost: counts and times of day have more than six.
std::string cellText(const Statement& row, int column) {
  if (sqlite3_column_type(row.get(), column) != SQLITE_FLOAT) return row.text(column);
  const double value = row.number(column);
  if (!std::isfinite(value)) return row.text(column);
  char text[40];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

}  // namespace

TextTable Catalogue::query(const std::string& sql) const try {
  Statement rows = impl_->database.prepare(sql);
  if (!sqlite3_stmt_readonly(rows.get()))
    throw ConfigError("query: only SELECT is allowed: the catalogue is read");
  TextTable table;
  for (int i = 0; i < rows.columns(); ++i) table.columns.push_back(rows.columnName(i));
  table.numeric.assign(table.columns.size(), true);
  while (rows.step()) {
    std::vector<std::string> cells;
    for (int i = 0; i < rows.columns(); ++i) {
      cells.push_back(cellText(rows, i));
      if (sqlite3_column_type(rows.get(), i) == SQLITE_TEXT)
        table.numeric[static_cast<std::size_t>(i)] = false;
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
} catch (const RunError& error) {
  throw ConfigError(std::string("query: ") + error.what() +
                    "; tables: runs, inputs, figures, parameters, run_parameters, timings, failures, files");
}

}  // namespace roomgraph
