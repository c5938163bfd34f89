// SPDX-License-Identifier: BSD-3-Clause
// Catalogue: the SQLite database of all runs of a batch.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roomgraph/catalogue/run_result.h"

namespace roomgraph {

/// What the catalogue says of one run in a line.
struct RunLine {
  std::int64_t id = 0;
  std::string name, input, group, variant, status, reason;
  std::optional<std::int64_t> seed;
  std::string revision;
  double wall_s = 0, cpu_s = 0, peak_memory_mb = 0;
  int failed_attempts = 0;
};

/// What runs of one recording took so far.
struct PastCost {
  std::string sha256;
  std::int64_t bytes = 0;
  double peak_memory_mb = 0, wall_s = 0;  ///< largest
};

/// One figure of one run.
struct FigureValue {
  std::int64_t run = 0;  ///< RunLine::id
  double value = 0;
};

/// Rows of texts below their headings.
struct TextTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<bool> numeric = {};  ///< by column; empty: none
};

/// How far importing is: results looked at, results in all.
using ImportProgress = std::function<void(std::size_t done, std::size_t total)>;

/// The database of a batch (docs/formats.md). It holds nothing that is not in the result files of the runs,
/// but for a cache of checksums, so it can be made again at any time. One process writes, others may read
/// meanwhile.
class Catalogue {
 public:
  /// Makes it when it is not there. Throws RunError.
  static Catalogue forWriting(const std::filesystem::path& file);
  /// Throws InputError: not there, or no catalogue of this version.
  static Catalogue forReading(const std::filesystem::path& file);
  Catalogue(Catalogue&&) noexcept;
  ~Catalogue();

  /// Takes one result in, in place of an earlier one of that name. `stamp`: of its file (stampOf()).
  void import(const RunResult& result, const std::string& stamp);
  /// Takes in each RUNS/NAME/result.json that is new or has changed, and forgets runs that have none. Returns
  /// the files that cannot be read, one sentence each.
  std::vector<std::string> importFolder(const std::filesystem::path& runs,
                                        const ImportProgress& progress = {});

  /// SHA-256 of a file that was reckoned before, when the file has not changed since by size and time.
  std::optional<std::string> checksum(const std::filesystem::path& file, const std::string& stamp) const;
  void rememberChecksum(const std::filesystem::path& file, const std::string& stamp,
                        const std::string& sha256);

  /// All runs, by name.
  std::vector<RunLine> runs() const;
  std::vector<FailedAttempt> failuresOf(std::int64_t run) const;
  std::vector<std::string> figureNames() const;
  /// Of every run that has it, in the order of their ids.
  std::vector<FigureValue> figure(const std::string& name) const;
  std::vector<PastCost> pastCosts() const;
  /// Any SELECT, shown as texts. Throws ConfigError: no SQL, or one that writes.
  TextTable query(const std::string& sql) const;

 private:
  struct Impl;
  explicit Catalogue(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Size and time of last change of a file, by which a change is noticed; empty when it is not there.
std::string stampOf(const std::filesystem::path& file);

}  // namespace roomgraph
