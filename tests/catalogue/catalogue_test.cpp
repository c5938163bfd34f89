// SPDX-License-Identifier: BSD-3-Clause
// Results into the catalogue and out of it again.
#include "roomgraph/catalogue/catalogue.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "made_up_results.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class InCatalogue : public ::testing::Test {
 protected:
  void leave(const RunResult& result) const {
    std::filesystem::create_directories(runs / result.name);
    writeRunResult(result, runs / result.name / "result.json");
  }
  std::string cell(const std::string& sql) const {
    const TextTable table = Catalogue::forReading(file).query(sql);
    return table.rows.empty() ? "nothing" : table.rows[0][0];
  }
  /// Every table but the cache, as text.
  std::string everything() const {
    std::string text;
    const Catalogue catalogue = Catalogue::forReading(file);
    for (const char* sql :
         {"SELECT runs.name, inputs.name, input_group, seed, path, inputs.sha256, bytes, variant, status, "
          "key, exit_code, reason, started, "
          "wall_s, cpu_s, peak_memory_mb, version, revision, program FROM runs JOIN inputs ON inputs.id = "
          "input_id ORDER BY 1",
          "SELECT * FROM figures ORDER BY run, figure",
          "SELECT * FROM run_parameters ORDER BY run, parameter",
          "SELECT name, stage, calls, total_ms, max_ms FROM timings JOIN runs ON id = run_id ORDER BY 1, 2",
          "SELECT name, attempt, failures.exit_code, failures.reason FROM failures JOIN runs ON id = run_id "
          "ORDER BY 1, 2",
          "SELECT runs.name, files.name, bytes FROM files JOIN runs ON id = run_id ORDER BY 1, 2"})
      for (const auto& row : catalogue.query(sql).rows) {
        for (const auto& value : row) text += value + "|";
        text += "\n";
      }
    return text;
  }
  const TemporaryFolder folder;
  const std::filesystem::path runs = folder.path() / "runs", file = folder.path() / "catalogue.sqlite";
};

TEST_F(InCatalogue, EveryPartOfAResultIsInATable) {
  leave(madeUpResult("lab", 3, "no_lidar"));
  EXPECT_THAT(Catalogue::forWriting(file).importFolder(runs), IsEmpty());
  const auto lines = Catalogue::forReading(file).runs();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].name, "lab_s3--no_lidar");
  EXPECT_EQ(lines[0].group, "lab");
  EXPECT_EQ(lines[0].seed, 3);
  EXPECT_EQ(lines[0].failed_attempts, 1);
  EXPECT_EQ(lines[0].wall_s, 13);
  EXPECT_EQ(cell("SELECT value FROM figures WHERE figure = 'trajectory.ate_rmse_m' AND variant = 'no_lidar'"),
            "0.03");
  EXPECT_EQ(cell("SELECT value FROM run_parameters WHERE parameter = 'lidar.enabled'"), "false");
  EXPECT_EQ(cell("SELECT total_ms FROM timings WHERE stage = 'association'"), "4.25");
  EXPECT_EQ(cell("SELECT reason FROM failures"), "killed");
  EXPECT_EQ(cell("SELECT bytes FROM files WHERE name = 'map.rgmap'"), "33304");
  EXPECT_EQ(cell("SELECT path FROM inputs"), "/data/lab.rawlog");
}

TEST_F(InCatalogue, MadeAgainFromTheRunsItIsTheSame) {
  for (int seed = 1; seed <= 3; ++seed)
    for (const char* variant : {"default", "no_lidar"}) leave(madeUpResult("lab", seed, variant));
  {
    Catalogue catalogue = Catalogue::forWriting(file);
    catalogue.importFolder(runs);
    RunResult changed = madeUpResult("lab", 2, "default");  // done again, with another outcome
    changed.status = "failed";
    changed.figures = {{"objects.recall", 0.25}};
    changed.failures.push_back({"later", 1, "no pose", 1});
    leave(changed);
    std::filesystem::remove_all(runs / "lab_s3--default");
    catalogue.importFolder(runs);
  }
  const std::string grown = everything();
  EXPECT_THAT(grown, HasSubstr("no pose"));
  EXPECT_THAT(grown, ::testing::Not(HasSubstr("lab_s3--default")));
  std::filesystem::remove(file);
  Catalogue::forWriting(file).importFolder(runs);
  EXPECT_EQ(everything(), grown);
  EXPECT_EQ(cell("SELECT count(*) FROM configs"), "2") << "one for each variant";
}

TEST_F(InCatalogue, OnlyWhatChangedIsRead) {
  for (int seed = 1; seed <= 4; ++seed) leave(madeUpResult("lab", seed, "default"));
  Catalogue catalogue = Catalogue::forWriting(file);
  std::size_t read = 0;
  const auto count = [&](std::size_t, std::size_t total) { read = total; };
  catalogue.importFolder(runs, count);
  EXPECT_EQ(read, 4u);
  catalogue.importFolder(runs, count);
  EXPECT_EQ(read, 0u);
  RunResult slower = madeUpResult("lab", 2, "default");
  slower.wall_s = 99;
  leave(slower);
  catalogue.importFolder(runs, count);
  EXPECT_EQ(read, 1u);
  EXPECT_EQ(cell("SELECT max(wall_s) FROM runs"), "99");
}

TEST_F(InCatalogue, ABrokenResultCostsItselfOnly) {
  leave(madeUpResult("lab", 1, "default"));
  std::filesystem::create_directories(runs / "odd");
  std::ofstream(runs / "odd" / "result.json") << "{";
  std::filesystem::create_directories(runs / "unfinished");
  EXPECT_THAT(Catalogue::forWriting(file).importFolder(runs), ElementsAre(HasSubstr("odd")));
  EXPECT_EQ(Catalogue::forReading(file).runs().size(), 1u);
}

TEST_F(InCatalogue, ChecksumsCountWhileTheFileIsTheSame) {
  Catalogue catalogue = Catalogue::forWriting(file);
  const auto data = folder.write("data", "abc");
  const std::string stamp = stampOf(data);
  EXPECT_FALSE(catalogue.checksum(data, stamp));
  catalogue.rememberChecksum(data, stamp, "f00");
  EXPECT_EQ(catalogue.checksum(data, stamp), "f00");
  folder.write("data", "abcd");
  EXPECT_NE(stampOf(data), stamp);
  EXPECT_FALSE(catalogue.checksum(data, stampOf(data)));
  EXPECT_EQ(stampOf(folder.file("none")), "");
}

TEST_F(InCatalogue, CostsAreTheLargestOfEachInput) {
  Catalogue catalogue = Catalogue::forWriting(file);
  for (int seed : {1, 7, 4}) catalogue.import(madeUpResult("lab", seed, "default"), "");
  RunResult failed = madeUpResult("lab", 9, "default");
  failed.status = "failed";
  catalogue.import(failed, "");
  const auto costs = catalogue.pastCosts();
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_EQ(costs[0].peak_memory_mb, 207);
  EXPECT_EQ(costs[0].bytes, 1000);
}

TEST_F(InCatalogue, IsOnlyRead) {
  Catalogue::forWriting(file).import(madeUpResult("lab", 1, "default"), "");
  const auto problem = [&](const std::string& sql) {
    return messageOf<ConfigError>([&] { Catalogue::forReading(file).query(sql); });
  };
  EXPECT_THAT(problem("DELETE FROM runs"), HasSubstr("only SELECT"));
  EXPECT_THAT(problem("SELECT nothing FROM runs"), HasSubstr("nothing"));
  EXPECT_EQ(cell("SELECT 1700000000.25"), "1700000000.25") << "no digit is lost";
  EXPECT_EQ(cell("SELECT 0.1"), "0.1");
  EXPECT_EQ(Catalogue::forReading(file).runs().size(), 1u);
}

TEST_F(InCatalogue, OtherFilesAreRefused) {
  EXPECT_THAT(messageOf<InputError>([&] { Catalogue::forReading(file); }), HasSubstr("no such catalogue"));
  folder.write("catalogue.sqlite", std::string(5000, 'x'));
  EXPECT_NE(messageOf<InputError>([&] { Catalogue::forReading(file); }), "");
  EXPECT_NE(messageOf<RunError>([&] { Catalogue::forWriting(file); }), "");
}

}  // namespace
}  // namespace roomgraph::test
