// SPDX-License-Identifier: BSD-3-Clause
// Results into the tables of the catalogue, one by one or a folder at once.
#include <algorithm>
#include <unordered_map>

#include "catalogue_impl.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

// A transaction of so many results costs one write to the disk.
constexpr std::size_t kAtOnceResults = 500;

std::string configChecksum(const RunResult& result) {
  std::string text;
  for (const auto& [name, value] : result.parameters) text += name + "=" + value + "\n";
  return sha256Of(text);
}

std::unordered_map<std::string, std::string> knownStamps(const Database& database) {
  std::unordered_map<std::string, std::string> out;
  Statement rows = database.prepare("SELECT name, file_stamp FROM runs");
  while (rows.step()) out[rows.text(0)] = rows.text(1);
  return out;
}

}  // namespace

ResultImporter::ResultImporter(Database& database)
    : database_(database),
      put_input_(database.prepare(
          "INSERT INTO inputs(name, input_group, seed, path, sha256, bytes) VALUES(?,?,?,?,?,?) "
          "ON CONFLICT(name) DO UPDATE SET input_group=excluded.input_group, seed=excluded.seed, "
          "path=excluded.path, sha256=excluded.sha256, bytes=excluded.bytes")),
      find_input_(database.prepare("SELECT id FROM inputs WHERE name = ?")),
      put_config_(database.prepare("INSERT INTO configs(sha256) VALUES(?)")),
      find_config_(database.prepare("SELECT id FROM configs WHERE sha256 = ?")),
      put_parameter_(database.prepare("INSERT INTO parameters VALUES(?,?,?)")),
      find_run_(database.prepare("SELECT id FROM runs WHERE name = ?")),
      put_run_(database.prepare("INSERT INTO runs VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")),
      remove_run_(database.prepare("DELETE FROM runs WHERE id = ?")),
      put_figure_(database.prepare("INSERT INTO figure_values VALUES(?,?,?)")),
      put_timing_(database.prepare("INSERT INTO timings VALUES(?,?,?,?,?)")),
      put_failure_(database.prepare("INSERT INTO failures VALUES(?,?,?,?,?,?)")),
      put_file_(database.prepare("INSERT INTO files VALUES(?,?,?)")),
      remove_figures_(database.prepare(
          "DELETE FROM figure_values WHERE figure_id IN (SELECT id FROM figure_names) AND run_id = ?")),
      remove_timings_(database.prepare("DELETE FROM timings WHERE run_id = ?")),
      remove_failures_(database.prepare("DELETE FROM failures WHERE run_id = ?")),
      remove_files_(database.prepare("DELETE FROM files WHERE run_id = ?")) {}

std::int64_t ResultImporter::inputId(const RunInput& input) {
  put_input_.bind(input.name, input.group, input.seed, input.path, input.sha256, input.bytes).run();
  return find_input_.bind(input.name).firstInteger().value();
}

std::int64_t ResultImporter::configId(const RunResult& result) {
  const std::string checksum = configChecksum(result);
  if (const auto known = find_config_.bind(checksum).firstInteger()) return *known;
  put_config_.bind(checksum).run();
  const auto id = database_.lastId();
  for (const auto& [name, value] : result.parameters) put_parameter_.bind(id, name, value).run();
  return id;
}

std::int64_t ResultImporter::figureId(const std::string& name) {
  const auto known = figure_ids_.find(name);
  if (known != figure_ids_.end()) return known->second;
  database_.prepare("INSERT OR IGNORE INTO figure_names(name) VALUES(?)").bind(name).run();
  Statement find = database_.prepare("SELECT id FROM figure_names WHERE name = ?");
  return figure_ids_[name] = find.bind(name).firstInteger().value();
}

void ResultImporter::removeParts(std::int64_t run) {
  for (Statement* statement :
       {&remove_figures_, &remove_timings_, &remove_failures_, &remove_files_, &remove_run_})
    statement->bind(run).run();
}

void ResultImporter::remove(const std::string& run) {
  if (const auto id = find_run_.bind(run).firstInteger()) removeParts(*id);
}

void ResultImporter::put(const RunResult& r, const std::string& stamp) {
  const auto id = find_run_.bind(r.name).firstInteger();
  if (id) removeParts(*id);
  put_run_
      .bind(id, r.name, inputId(r.input), r.variant, r.status, r.key, configId(r), r.exit_code, r.reason,
            r.started, r.wall_s, r.cpu_s, r.peak_memory_mb, r.version, r.revision, r.program, stamp)
      .run();
  const std::int64_t run = id ? *id : database_.lastId();
  for (const auto& [name, value] : r.figures) put_figure_.bind(figureId(name), run, value).run();
  for (const auto& [stage, t] : r.timings) put_timing_.bind(run, stage, t.calls, t.total_ms, t.max_ms).run();
  int attempt = 0;
  for (const auto& f : r.failures)
    put_failure_.bind(run, ++attempt, f.started, f.exit_code, f.reason, f.wall_s).run();
  for (const auto& [name, bytes] : r.files) put_file_.bind(run, name, bytes).run();
}

void Catalogue::import(const RunResult& result, const std::string& stamp) {
  Transaction transaction(impl_->database);
  impl_->importer->put(result, stamp);
  transaction.commit();
}

std::vector<std::string> Catalogue::importFolder(const std::filesystem::path& runs,
                                                 const ImportProgress& progress) {
  auto gone = knownStamps(impl_->database);
  std::vector<std::pair<std::filesystem::path, std::string>> changed;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(runs, unreadable)) {
    const auto file = entry.path() / "result.json";
    const std::string stamp = stampOf(file);
    if (stamp.empty()) continue;
    const auto known = gone.find(entry.path().filename().string());
    if (known == gone.end() || known->second != stamp) changed.emplace_back(file, stamp);
    if (known != gone.end()) gone.erase(known);
  }
  std::sort(changed.begin(), changed.end());
  std::vector<std::string> problems;
  for (std::size_t begin = 0; begin < changed.size() || begin == 0; begin += kAtOnceResults) {
    const std::size_t end = std::min(begin + kAtOnceResults, changed.size());
    Transaction transaction(impl_->database);
    for (std::size_t i = begin; i < end; ++i) {
      try {
        RunResult result = readRunResult(changed[i].first);
        result.name =
            changed[i].first.parent_path().filename().string();  // where it lies now is where it is found
        impl_->importer->put(result, changed[i].second);
      } catch (const InputError& error) {
        problems.push_back(error.what());
      }
    }
    if (begin == 0)
      for (const auto& [name, stamp] : gone) impl_->importer->remove(name);
    transaction.commit();
    if (progress) progress(end, changed.size());
  }
  return problems;
}

}  // namespace roomgraph
