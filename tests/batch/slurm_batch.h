// SPDX-License-Identifier: BSD-3-Clause
// Batches on a Slurm of one node that bench/slurm_here.sh starts for the test.
#pragma once

#include "small_batch.h"

namespace roomgraph::test {

/// Output of a command of the shell, and what it printed to standard error.
inline std::string said(const std::string& command) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return "cannot be started";
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  return text;
}

/// A Slurm of its own; the commands of Slurm speak to it while it exists.
class SlurmHere {
 public:
  explicit SlurmHere(const std::string& settings) {
    std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755));
    const std::string answer = tell("start", settings);
    if (!answer.starts_with("export SLURM_CONF=")) throw std::runtime_error(answer);
    setenv("SLURM_CONF", folder_.file("slurm/slurm.conf").c_str(), 1);
  }
  ~SlurmHere() {
    tell("stop");
    unsetenv("SLURM_CONF");
  }
  SlurmHere(const SlurmHere&) = delete;
  SlurmHere& operator=(const SlurmHere&) = delete;
  std::string tell(const std::string& word, const std::string& more = "") const {
    return said(std::string(ROOMGRAPH_SOURCE_DIR) + "/bench/slurm_here.sh " + word + " " +
                folder_.file("slurm").string() + " " + more);
  }

 private:
  const TemporaryFolder folder_;
};

/// Batches with `--engine slurm`.
class SlurmBatch : public SmallBatch {
 protected:
  static void SetUpTestSuite() { slurm = std::make_unique<SlurmHere>("CPUS=4 SlurmdTimeout=5"); }
  static void TearDownTestSuite() { slurm.reset(); }
  void TearDown() override {
    said("scancel --user=$(id -u); scontrol update NodeName=node0 State=RESUME");
    EXPECT_TRUE(waitUntil([] { return active().empty(); })) << said("squeue");
  }
  /// All different: those alike share their detections, and wait for the first one.
  void makeRecordings(const std::vector<std::string>& names, int steps) const {
    for (const auto& name : names) makeRecording(name, steps++);
  }
  std::string slurmJobs(const std::string& variants, const std::string& more = "") const {
    return jobs(variants, "keep: summary\n" + more + "slurm: {poll: 0.3 s, patience: 1 s, memory: 200 MB" +
                              options + "}\n");
  }
  std::vector<std::string> words(const std::string& job_file) const {
    return {job_file, "-o", "out", "--engine", "slurm"};
  }
  /// "JOB_INDEX STATE" of those that are not over.
  static std::vector<std::string> active() { return linesOf(said("squeue -h -r -o '%F_%K %T'")); }
  static std::size_t countOf(const std::string& state) {
    const auto lines = active();
    return static_cast<std::size_t>(
        std::count_if(lines.begin(), lines.end(), [&](const auto& line) { return line.ends_with(state); }));
  }
  /// Tasks that this batch ever gave to the queue.
  std::size_t submitted(const std::string& err) const {
    std::size_t count = 0;
    for (const auto& line : linesOf(err))
      if (line.starts_with("submitted ")) count += std::stoul(line.substr(line.find(": ") + 2));
    return count;
  }
  void expectAllComplete(std::size_t runs) const {
    const auto all = catalogued();
    EXPECT_EQ(all.size(), runs);
    for (const auto& run : all) EXPECT_EQ(run.status, "complete") << run.name << ": " << run.reason;
  }
  static std::unique_ptr<SlurmHere> slurm;
  std::string options;
};

inline std::unique_ptr<SlurmHere> SlurmBatch::slurm;

}  // namespace roomgraph::test
