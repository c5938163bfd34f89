// SPDX-License-Identifier: BSD-3-Clause
// SQL of the catalogue's tables. Everything in it but the cache of checksums comes from result files.
#include "schema.h"

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

constexpr std::int64_t kApplication = 0x726d6763;  // "rmgc"
constexpr std::int64_t kSchemaVersion = 1;

// Figures are kept figure by figure, so that a comparison reads one stretch of the file. Configurations are
// kept once however many runs share them.
constexpr const char* kTables = R"(
CREATE TABLE inputs(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, input_group TEXT NOT NULL, seed INTEGER,
  path TEXT NOT NULL, sha256 TEXT NOT NULL, bytes INTEGER NOT NULL);
CREATE TABLE configs(id INTEGER PRIMARY KEY, sha256 TEXT NOT NULL UNIQUE);
CREATE TABLE parameters(config_id INTEGER NOT NULL REFERENCES configs(id), name TEXT NOT NULL, value TEXT NOT NULL,
  PRIMARY KEY(config_id, name)) WITHOUT ROWID;
CREATE TABLE runs(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, input_id INTEGER NOT NULL REFERENCES inputs(id),
  variant TEXT NOT NULL, status TEXT NOT NULL, key TEXT NOT NULL, config_id INTEGER NOT NULL REFERENCES configs(id),
  exit_code INTEGER NOT NULL, reason TEXT NOT NULL, started TEXT NOT NULL, wall_s REAL NOT NULL, cpu_s REAL NOT NULL,
  peak_memory_mb REAL NOT NULL, version TEXT NOT NULL, revision TEXT NOT NULL, program TEXT NOT NULL, file_stamp TEXT NOT NULL);
CREATE INDEX runs_by_input ON runs(input_id);
CREATE TABLE figure_names(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE);
CREATE TABLE figure_values(figure_id INTEGER NOT NULL REFERENCES figure_names(id), run_id INTEGER NOT NULL REFERENCES runs(id),
  value REAL NOT NULL, PRIMARY KEY(figure_id, run_id)) WITHOUT ROWID;
CREATE TABLE timings(run_id INTEGER NOT NULL REFERENCES runs(id), stage TEXT NOT NULL, calls INTEGER NOT NULL,
  total_ms REAL NOT NULL, max_ms REAL NOT NULL, PRIMARY KEY(run_id, stage)) WITHOUT ROWID;
CREATE TABLE failures(run_id INTEGER NOT NULL REFERENCES runs(id), attempt INTEGER NOT NULL, started TEXT NOT NULL,
  exit_code INTEGER NOT NULL, reason TEXT NOT NULL, wall_s REAL NOT NULL, PRIMARY KEY(run_id, attempt)) WITHOUT ROWID;
CREATE TABLE files(run_id INTEGER NOT NULL REFERENCES runs(id), name TEXT NOT NULL, bytes INTEGER NOT NULL,
  PRIMARY KEY(run_id, name)) WITHOUT ROWID;
CREATE TABLE checksums(path TEXT PRIMARY KEY, stamp TEXT NOT NULL, sha256 TEXT NOT NULL) WITHOUT ROWID;
CREATE VIEW figures AS SELECT runs.name AS run, inputs.name AS input, inputs.input_group, inputs.seed, runs.variant,
  figure_names.name AS figure, figure_values.value, runs.revision FROM figure_values
  JOIN figure_names ON figure_names.id = figure_id JOIN runs ON runs.id = run_id JOIN inputs ON inputs.id = input_id
  WHERE runs.status = 'complete';
CREATE VIEW run_parameters AS SELECT runs.name AS run, runs.variant, parameters.name AS parameter, parameters.value
  FROM runs JOIN parameters ON parameters.config_id = runs.config_id;
)";

std::string faultOf(const Database& database) {
  if (database.integer("PRAGMA application_id") != kApplication)
    return database.name() + ": is no catalogue of runs";
  const auto version = database.integer("PRAGMA user_version");
  if (version == kSchemaVersion) return "";
  return database.name() + ": is of version " + std::to_string(version) + ", this program reads version " +
         std::to_string(kSchemaVersion) +
         "; remove it, and 'roomgraph batch import' makes it again from the runs";
}

}  // namespace

void makeSchema(Database& database) {
  database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA foreign_keys = ON");
  if (database.integer("SELECT count(*) FROM sqlite_schema") == 0) {
    Transaction transaction(database);
    database.execute(kTables);
    database.execute("PRAGMA application_id = " + std::to_string(kApplication));
    database.execute("PRAGMA user_version = " + std::to_string(kSchemaVersion));
    transaction.commit();
  }
  if (const std::string fault = faultOf(database); !fault.empty()) throw RunError(fault);
}

void requireSchema(const Database& database) try {
  if (const std::string fault = faultOf(database); !fault.empty()) throw InputError(fault);
} catch (const RunError& error) {  // the first look into the file
  throw InputError(error.what());
}

}  // namespace roomgraph
