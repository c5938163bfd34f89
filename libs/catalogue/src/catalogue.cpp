// SPDX-License-Identifier: BSD-3-Clause
// Opening of the catalogue, and what it is asked most.
#include "roomgraph/catalogue/catalogue.h"

#include <sys/stat.h>

#include "catalogue_impl.h"
#include "schema.h"

namespace roomgraph {

Catalogue::Catalogue(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Catalogue::Catalogue(Catalogue&&) noexcept = default;
Catalogue::~Catalogue() = default;

Catalogue Catalogue::forWriting(const std::filesystem::path& file) {
  auto impl = std::make_unique<Impl>(file, Database::Mode::kReadWrite);
  makeSchema(impl->database);
  impl->importer = std::make_unique<ResultImporter>(impl->database);
  return Catalogue(std::move(impl));
}

Catalogue Catalogue::forReading(const std::filesystem::path& file) {
  auto impl = std::make_unique<Impl>(file, Database::Mode::kReadOnly);
  requireSchema(impl->database);
  return Catalogue(std::move(impl));
}

std::optional<std::string> Catalogue::checksum(const std::filesystem::path& file,
                                               const std::string& stamp) const {
  Statement find = impl_->database.prepare("SELECT sha256 FROM checksums WHERE path = ? AND stamp = ?");
  if (!find.bind(file.string(), stamp).step()) return std::nullopt;
  return find.text(0);
}

void Catalogue::rememberChecksum(const std::filesystem::path& file, const std::string& stamp,
                                 const std::string& sha256) {
  impl_->database.prepare("INSERT OR REPLACE INTO checksums VALUES(?,?,?)")
      .bind(file.string(), stamp, sha256)
      .run();
}

std::vector<RunLine> Catalogue::runs() const {
  Statement rows = impl_->database.prepare(
      "SELECT runs.id, runs.name, inputs.name, input_group, variant, status, reason, seed, revision, wall_s, "
      "cpu_s, "
      "peak_memory_mb, (SELECT count(*) FROM failures WHERE run_id = runs.id) FROM runs JOIN inputs ON "
      "inputs.id = input_id "
      "ORDER BY runs.name");
  std::vector<RunLine> out;
  while (rows.step()) {
    RunLine line{rows.integer(0), rows.text(1), rows.text(2), rows.text(3), rows.text(4),
                 rows.text(5),    rows.text(6), {},           rows.text(8)};
    if (!rows.isNull(7)) line.seed = rows.integer(7);
    line.wall_s = rows.number(9);
    line.cpu_s = rows.number(10);
    line.peak_memory_mb = rows.number(11);
    line.failed_attempts = static_cast<int>(rows.integer(12));
    out.push_back(std::move(line));
  }
  return out;
}

std::vector<FailedAttempt> Catalogue::failuresOf(std::int64_t run) const {
  Statement rows = impl_->database.prepare(
      "SELECT started, exit_code, reason, wall_s FROM failures WHERE run_id = ? ORDER BY attempt");
  std::vector<FailedAttempt> out;
  rows.bind(run);
  while (rows.step())
    out.push_back({rows.text(0), static_cast<int>(rows.integer(1)), rows.text(2), rows.number(3)});
  return out;
}

std::vector<std::string> Catalogue::figureNames() const {
  Statement rows = impl_->database.prepare("SELECT name FROM figure_names ORDER BY name");
  std::vector<std::string> out;
  while (rows.step()) out.push_back(rows.text(0));
  return out;
}

std::vector<FigureValue> Catalogue::figure(const std::string& name) const {
  Statement rows = impl_->database.prepare(
      "SELECT run_id, value FROM figure_values WHERE figure_id = (SELECT id FROM figure_names WHERE name = "
      "?)");
  std::vector<FigureValue> out;
  rows.bind(name);
  while (rows.step()) out.push_back({rows.integer(0), rows.number(1)});
  return out;
}

std::vector<PastCost> Catalogue::pastCosts() const {
  Statement rows = impl_->database.prepare(
      "SELECT sha256, max(bytes), max(peak_memory_mb), max(wall_s) FROM runs JOIN inputs ON inputs.id = "
      "input_id "
      "WHERE status = 'complete' GROUP BY sha256");
  std::vector<PastCost> out;
  while (rows.step()) out.push_back({rows.text(0), rows.integer(1), rows.number(2), rows.number(3)});
  return out;
}

std::string stampOf(const std::filesystem::path& file) {
  struct stat found {};
  if (stat(file.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return "";
  return std::to_string(found.st_size) + "," + std::to_string(found.st_mtim.tv_sec) + "," +
         std::to_string(found.st_mtim.tv_nsec);
}

}  // namespace roomgraph
