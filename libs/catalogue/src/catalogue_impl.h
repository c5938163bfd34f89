// SPDX-License-Identifier: BSD-3-Clause
// Connection of a Catalogue, and the statements that put a result in.
#pragma once

#include <map>

#include "database.h"
#include "roomgraph/catalogue/catalogue.h"

namespace roomgraph {

/// Statements of an import, prepared once.
class ResultImporter {
 public:
  explicit ResultImporter(Database& database);
  /// Within a transaction.
  void put(const RunResult& result, const std::string& stamp);
  void remove(const std::string& run);

 private:
  std::int64_t inputId(const RunInput& input);
  std::int64_t configId(const RunResult& result);
  std::int64_t figureId(const std::string& name);
  void removeParts(std::int64_t run);

  Database& database_;
  Statement put_input_, find_input_, put_config_, find_config_, put_parameter_, find_run_, put_run_,
      remove_run_, put_figure_, put_timing_, put_failure_, put_file_, remove_figures_, remove_timings_,
      remove_failures_, remove_files_;
  std::map<std::string, std::int64_t> figure_ids_;
};

struct Catalogue::Impl {
  Impl(const std::filesystem::path& file, Database::Mode mode) : database(file, mode) {}
  Database database;
  std::unique_ptr<ResultImporter> importer;  ///< nothing: opened for reading
};

}  // namespace roomgraph
