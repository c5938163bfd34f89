// SPDX-License-Identifier: BSD-3-Clause
// Batches of recordings of a second, started as users do.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "program.h"
#include "roomgraph/catalogue/catalogue.h"
#include "roomgraph/catalogue/run_result.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {

/// A folder with recordings (a.rawlog, b.rawlog...) and the batch in out/.
class SmallBatch : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder.file("data")); }
  void makeRecording(const std::string& name, int steps = 8) const {
    writeRawlog(folder.file("data/" + name + ".rawlog"), TinyRecording(steps).records({}));
  }
  CallResult batch(const std::vector<std::string>& words) const {
    return call(folder.path(), withBatch(words), folder.path());
  }
  Program started(const std::vector<std::string>& words) const {
    return Program(folder.path(), withBatch(words), folder.path());
  }
  /// Every recording, with the configurations of `variants` (lines of YAML), and further keys.
  std::string jobs(const std::string& variants = "  - name: default\n", const std::string& more = "") const {
    folder.write("jobs.yaml", "inputs: [data/*.rawlog]\nvariants:\n" + variants + more);
    return "jobs.yaml";
  }
  std::filesystem::path runFolder(const std::string& run) const {
    return folder.path() / "out" / "runs" / run;
  }
  RunResult result(const std::string& run) const { return readRunResult(runFolder(run) / "result.json"); }
  std::vector<RunLine> catalogued() const {
    return Catalogue::forReading(folder.file("out/catalogue.sqlite")).runs();
  }
  /// What runs leave that is the same each time.
  std::map<std::string, std::string> results() const {
    std::map<std::string, std::string> out;
    for (const auto& run : std::filesystem::directory_iterator(folder.file("out/runs")))
      for (const char* name :
           {"trajectory.tum", "landmarks.json", "map.pgm", "graph.g2o", "associations.jsonl"}) {
        const auto file = run.path() / name;
        if (std::filesystem::exists(file)) out[run.path().filename().string() + "/" + name] = contentOf(file);
      }
    return out;
  }
  /// Processes whose command line names this folder, but for the batch itself.
  std::vector<pid_t> tasks(const std::string& word = "") const {
    std::vector<pid_t> out;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
      const std::string name = entry.path().filename().string();
      if (!std::isdigit(static_cast<unsigned char>(name[0]))) continue;
      const std::string words = contentOf(entry.path() / "cmdline");
      const bool ours = words.find(folder.path().string()) != std::string::npos &&
                        words.find("roomgraph") != std::string::npos;
      if (ours && words.find('\0' + word) != std::string::npos) out.push_back(std::stoi(name));
    }
    return out;
  }
  static bool waitUntil(const std::function<bool()>& happened, double seconds = 30) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!happened()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

  const TemporaryFolder folder;

 private:
  static std::vector<std::string> withBatch(const std::vector<std::string>& words) {
    std::vector<std::string> out{"batch"};
    out.insert(out.end(), words.begin(), words.end());
    return out;
  }
};

}  // namespace roomgraph::test
