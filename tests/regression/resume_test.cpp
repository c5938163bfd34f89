// SPDX-License-Identifier: BSD-3-Clause
// Runs that are killed or interrupted and gone on with: the files of an undisturbed run, byte by byte.
#include <signal.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "program.h"
#include "rated_networks.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

/// The files of a folder; of the summary all but times, memory and whether the run was taken up again.
Files resultsIn(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name == "timings.csv" || name == "report.html") continue;
    files[name] = entry.is_regular_file() ? contentOf(entry.path()) : "a folder";
  }
  auto summary = nlohmann::json::parse(files["summary.json"]);
  for (const char* differs : {"timings", "peak_memory_mb", "wall_s", "command", "resumed"}) summary.erase(differs);
  files["summary.json"] = summary.dump(1);
  return files;
}

void expectSame(const Files& whole, const Files& resumed) {
  EXPECT_GE(whole.size(), 15u);
  for (const auto& [name, content] : whole)
    EXPECT_TRUE(resumed.contains(name) && resumed.at(name) == content) << name << " differs";
  EXPECT_EQ(whole.size(), resumed.size()) << "something was left behind";
}

class Resume : public ::testing::Test {
 protected:
  void record(int steps, const TinyRecording::Parts& parts) {
    test::writeRawlog(recording, TinyRecording(steps).records(parts), false);
  }
  std::vector<std::string> words(const fs::path& to, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", recording.string(), "-o", to.string(), "--quiet", "--no-snapshot"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  CallResult resume(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", "--resume", out.string(), "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return call(folder.path(), all);
  }
  Files undisturbed(const std::vector<std::string>& more = {}) {
    const auto begin = std::chrono::steady_clock::now();
    const CallResult result = call(folder.path(), words(folder.file("whole"), more));
    undisturbed_time = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return resultsIn(folder.file("whole"));
  }
  /// Starts a run, and returns it when so many bytes of live poses are on the disk.
  Program started(const std::vector<std::string>& arguments, std::uintmax_t live_bytes,
                  const fs::path& working_folder = fs::current_path()) const {
    Program program(folder.path(), arguments, working_folder);
    for (int i = 0; i < 6000; ++i) {
      std::error_code none_yet;
      const auto bytes = fs::file_size(out / "roomgraph_unfinished" / "live.tum", none_yet);
      if (!none_yet && bytes > live_bytes) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return program;
  }
  void killOne(const std::vector<std::string>& arguments, std::uintmax_t live_bytes = 4000,
               const fs::path& working_folder = fs::current_path()) const {
    Program program = started(arguments, live_bytes, working_folder);
    ASSERT_EQ(kill(program.pid(), SIGKILL), 0);
    EXPECT_EQ(program.wait().exit_code, -1) << "it had ended before it was killed";
  }
  std::size_t journalBytes() const { return fs::file_size(checkpoint / "results.journal"); }

  TemporaryFolder folder;
  std::chrono::duration<double> undisturbed_time{};
  const fs::path recording = folder.file("a.rawlog"), out = folder.file("out"),
                 checkpoint = out / "roomgraph_checkpoint";
};

/// Kills and resumes until a run comes to its end; returns how often it was killed. The moments lie in the first
/// half of the time that an undisturbed run takes on this machine, whatever that is.
int killAtRandom(const TemporaryFolder& folder, const std::vector<std::string>& begin, const fs::path& out,
                 std::chrono::duration<double> undisturbed, unsigned seed, int most) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(.02, .5);
  int kills = 0;
  for (;;) {
    const bool resume = fs::exists(out / "roomgraph_checkpoint" / "run.json");
    Program program(folder.path(),
                    resume ? std::vector<std::string>{"run", "--resume", out.string(), "--quiet"} : begin);
    if (kills == most) {
      const CallResult result = program.wait();
      EXPECT_EQ(result.exit_code, 0) << result.err;
      return kills;
    }
    std::this_thread::sleep_for(share(random) * undisturbed);
    kill(program.pid(), SIGKILL);
    if (program.wait().exit_code == 0) return kills;
    ++kills;
  }
}

TEST_F(Resume, KilledAtRandomMomentsWithAllSensorsAndTheNetwork) {
  record(60, {});
  const Files whole = undisturbed();
  EXPECT_NE(nlohmann::json::parse(contentOf(folder.file("whole") / "summary.json"))["detector"]["model_hash"],
            "");
  int kills = 0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    fs::remove_all(out);
    kills += killAtRandom(folder, words(out), out, undisturbed_time, seed, 4);
    expectSame(whole, resultsIn(out));
  }
  EXPECT_GE(kills, 3);
}

TEST_F(Resume, KilledAtRandomMomentsWithRecordedBoxes) {
  fs::copy_file(fs::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rawlog", recording);
  const Files whole = undisturbed();
  for (const unsigned seed : {4u, 5u}) {
    fs::remove_all(out);
    killAtRandom(folder, words(out), out, undisturbed_time, seed, 4);
    expectSame(whole, resultsIn(out));
  }
}

TEST_F(Resume, KilledAtRandomMomentsWithNetworksOfDifferentRates) {
  fs::copy_file(fs::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rawlog", recording);
  const auto networks = ratedNetworks(folder.path());
  const Files whole = undisturbed(networks);
  EXPECT_GE(killAtRandom(folder, words(out, networks), out, undisturbed_time, 6, 3), 1);
  expectSame(whole, resultsIn(out));
}

TEST_F(Resume, TwiceAndWithOtherThreads) {
  record(400, {true, false, true});
  const Files whole = undisturbed();
  killOne(words(out, {"--threads", "1"}));
  const auto first = journalBytes();
  killOne({"run", "--resume", out.string(), "--quiet", "--threads", "4"}, 16000);
  EXPECT_GT(journalBytes(), first) << "the second attempt came further";
  const CallResult last = resume({"--threads", "2"});
  EXPECT_EQ(last.exit_code, 0) << last.err;
  expectSame(whole, resultsIn(out));
  const auto summary = nlohmann::json::parse(contentOf(out / "summary.json"));
  EXPECT_EQ(summary["resumed"], "yes");
  EXPECT_EQ(summary["command"][2], recording.string()) << "the words that began it";
}

TEST_F(Resume, FromAnotherFolderWithTheNamesOfThen) {
  record(400, {true, false, true});
  const Files whole = undisturbed();
  killOne({"run", "a.rawlog", "-o", "out", "--quiet", "--no-snapshot"}, 4000, folder.path());
  ASSERT_TRUE(fs::exists(checkpoint / "run.json"));
  fs::create_directory(folder.file("elsewhere"));
  const CallResult result =
      call(folder.path(), {"run", "--resume", "../out", "--quiet"}, folder.file("elsewhere"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  Files resumed = resultsIn(out);
  // The name of the recording as it was given.
  EXPECT_NE(resumed["summary.json"].find("\"a.rawlog\""), std::string::npos);
  resumed["summary.json"] = whole.at("summary.json");
  expectSame(whole, resumed);
}

TEST_F(Resume, AfterCtrlCGoesOnToTheWhole) {
  record(600, {true, false, true});
  const Files whole = undisturbed();
  Program program = started(words(out), 8000);
  ASSERT_EQ(kill(program.pid(), SIGINT), 0);
  const CallResult interrupted = program.wait();
  expectOneLine(interrupted, 4, HasSubstr("run --resume " + out.string()));
  EXPECT_EQ(nlohmann::json::parse(contentOf(out / "summary.json"))["interrupted"], "yes");
  EXPECT_LT(contentOf(out / "trajectory.tum").size(), whole.at("trajectory.tum").size());
  const CallResult result = resume();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expectSame(whole, resultsIn(out));
}

TEST_F(Resume, OnlyTheSameRun) {
  record(400, {true, false, true});
  const Files whole = undisturbed();
  killOne(words(out));
  const auto bytes = journalBytes();
  const auto refused = [&](const std::vector<std::string>& more, const std::string& why) {
    expectOneLine(resume(more), 2, AllOf(HasSubstr("is of another run"), HasSubstr(why)));
  };
  refused({"--set", "lidar.min_score=0.2"}, "lidar.min_score is 0.2 and was 0.1");
  refused({"--from", "1"}, "--from is 1 s and was 0 s");
  refused({"--until", "3"}, "--until is 3 s and was 0 s");
  refused({"--pose", "LASER=0,0,0.4,0,0,0"}, "pipeline.sensor_poses is");
  refused({"--map", (fs::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rgmap").string()},
          "--map is given");
  refused({"--save-detections", folder.file("boxes.rawlog").string()}, "--save-detections is");
  const auto time = fs::last_write_time(recording);
  fs::last_write_time(recording, time + std::chrono::seconds(1));
  refused({}, "time of the recording");
  fs::last_write_time(recording, time);
  const std::string bytes_of_recording = contentOf(recording);
  std::ofstream(recording, std::ios::binary | std::ios::app) << "more";
  refused({}, "size of the recording");
  std::ofstream(recording, std::ios::binary) << bytes_of_recording;
  fs::last_write_time(recording, time);
  EXPECT_EQ(journalBytes(), bytes) << "nothing of it was lost by all that";
  EXPECT_EQ(resume().exit_code, 0);
  expectSame(whole, resultsIn(out));
}

TEST_F(Resume, OfNothingOfAWholeRunAndOfOneUnderWay) {
  record(400, {true, false, true});
  expectOneLine(resume(), 3, HasSubstr("no such folder"));
  fs::create_directory(out);
  expectOneLine(resume(), 3, HasSubstr("there is no checkpoint"));
  EXPECT_TRUE(fs::is_empty(out));
  {
    Program first = started(words(out), 1000);
    ASSERT_EQ(kill(first.pid(), SIGSTOP), 0);
    expectOneLine(resume(), 1, HasSubstr("another process is writing into it"));
    expectOneLine(call(folder.path(), words(out)), 1, HasSubstr("another process is writing into it"));
    kill(first.pid(), SIGCONT);
    EXPECT_EQ(first.wait().exit_code, 0);
  }
  const Files whole = resultsIn(out);
  EXPECT_FALSE(fs::exists(checkpoint));
  const CallResult again = resume();
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("nothing to go on with"));
  expectSame(whole, resultsIn(out));
  expectOneLine(resume({"-o", folder.path().string()}), 2, HasSubstr("is not the output folder"));
}

// Whatever the end of the journal looks like: what is sound before it is used, and that is told.
TEST_F(Resume, WithADamagedJournal) {
  record(400, {true, false, true});
  const Files whole = undisturbed();
  killOne(words(out), 12000);
  const std::string journal = contentOf(checkpoint / "results.journal");
  ASSERT_GT(journal.size(), 1000u);
  const fs::path kept = folder.file("kept");
  fs::rename(checkpoint, kept);
  for (const std::size_t at : {journal.size() - 1, journal.size() / 2, std::size_t{30}}) {
    std::string damaged = journal;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    fs::remove_all(out);
    fs::create_directory(out);
    fs::copy(kept, checkpoint);
    std::ofstream(checkpoint / "results.journal", std::ios::binary) << damaged;
    const CallResult result = resume();
    expectOneLine(result, 0,
                  AllOf(HasSubstr("results of the interrupted run"), HasSubstr("damaged and left out")));
    expectSame(whole, resultsIn(out));
  }
  fs::create_directory(checkpoint);
  std::ofstream(checkpoint / "run.json") << "{\"command\": []";
  expectOneLine(resume(), 3, HasSubstr("run.json: not valid JSON"));
}

TEST_F(Resume, WithoutCheckpointsThereIsNone) {
  record(400, {true, false, true});
  killOne(words(out, {"--checkpoint", "0"}));
  EXPECT_FALSE(fs::exists(checkpoint));
  expectOneLine(resume(), 3, HasSubstr("there is no checkpoint"));
  killOne(words(out));
  ASSERT_TRUE(fs::exists(checkpoint));
  const CallResult anew = call(folder.path(), words(out));
  expectOneLine(anew, 0, HasSubstr("the checkpoint of an unfinished run is there"));
  EXPECT_FALSE(fs::exists(checkpoint));
}

}  // namespace
}  // namespace roomgraph::test
