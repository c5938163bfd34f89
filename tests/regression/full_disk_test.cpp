// SPDX-License-Identifier: BSD-3-Clause
// Commands on a disk that fills up: former results or new ones, never parts of both.
// A limit on the size of files stands for a disk that is full: writing fails in the middle of a file, with an
// error of its own. bench/faults.py does the same on real full disks, for which one must be root.
#include <signal.h>
#include <sys/resource.h>

#include <map>

#include "program.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

/// While it lives, no file of this process and its children grows beyond the limit.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit limit{bytes, former_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &former_);
    signal(SIGXFSZ, handler_);
  }

 private:
  rlimit former_{};
  void (*handler_)(int);
};

class FullDisk : public ::testing::Test {
 protected:
  CallResult limited(rlim_t bytes, const std::vector<std::string>& arguments) {
    const FileSizeLimit limit(bytes);
    return call(folder.path(), arguments);
  }
  std::map<std::string, std::string> contents(const std::filesystem::path& top) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top))
      // What a run had computed stays: see below.
      if (entry.is_regular_file() && entry.path().parent_path().filename() != "roomgraph_checkpoint")
        files[entry.path()] = contentOf(entry.path());
    return files;
  }
  /// With any limit that is too small the folder is as it was, and the message names a file.
  void expectAllOrNothing(const std::vector<rlim_t>& limits, const std::filesystem::path& top,
                          const std::vector<std::string>& arguments) {
    const auto before = contents(top);
    int failed = 0;
    for (const rlim_t limit : limits) {
      const CallResult result = limited(limit, arguments);
      if (result.exit_code == 0) continue;
      ++failed;
      expectOneLine(
          result, 1,
          ::testing::AllOf(HasSubstr("cannot write " + folder.path().string()), HasSubstr("File too large")));
      EXPECT_EQ(contents(top), before) << "limit " << limit;
      std::filesystem::remove_all(top / "roomgraph_checkpoint");  // of which the next run would tell
    }
    EXPECT_GT(failed, 0) << "no limit was reached";
  }

  TemporaryFolder folder;
  const std::filesystem::path place = folder.path() / "place";
};

TEST_F(FullDisk, ARunLeavesTheFormerResults) {
  test::writeRawlog(folder.file("a.rawlog"), TinyRecording(20).records({true, false, true}));
  test::writeRawlog(folder.file("b.rawlog"), TinyRecording(30).records({true, false, true}));
  ASSERT_EQ(call(folder.path(), {"run", folder.file("a.rawlog").string(), "-o", place.string(), "--quiet"})
                .exit_code,
            0);
  expectAllOrNothing({500, 2000, 3500, 6000, 10000, 20000, 40000}, place,
                     {"run", folder.file("b.rawlog").string(), "-o", place.string(), "--quiet"});
}

// Whatever was full, and however often: when there is room again the run goes on.
TEST_F(FullDisk, ARunIsGoneOnWithWhenThereIsRoomAgain) {
  test::writeRawlog(folder.file("a.rawlog"), TinyRecording(200).records({true, false, true}));
  const auto words = [&](const std::filesystem::path& to) {
    return std::vector<std::string>{
        "run", folder.file("a.rawlog").string(), "-o", to.string(), "--quiet", "--no-report"};
  };
  ASSERT_EQ(call(folder.path(), words(folder.file("whole"))).exit_code, 0);
  int left = 0;
  for (const rlim_t limit : {20000, 40000, 60000}) {
    const auto out = folder.path() / std::to_string(limit);
    const CallResult full = limited(limit, words(out));
    expectOneLine(full, 1, HasSubstr("File too large"));
    const bool kept = std::filesystem::exists(out / "roomgraph_checkpoint");
    left += kept;
    const CallResult resumed =
        call(folder.path(),
             kept ? std::vector<std::string>{"run", "--resume", out.string(), "--quiet"} : words(out));
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    for (const char* name :
         {"trajectory.tum", "landmarks.json", "map.rgmap", "graph.g2o", "live.tum", "snapshot.png"})
      EXPECT_TRUE(contentOf(out / name) == contentOf(folder.file("whole") / name))
          << name << ", limit " << limit;
  }
  EXPECT_GT(left, 0) << "no limit left a checkpoint";
}

TEST_F(FullDisk, SimulatedWorldsRecordingsAndGraphsAreWholeOrAbsent) {
  std::filesystem::create_directories(place);
  const std::filesystem::path source = ROOMGRAPH_SOURCE_DIR;
  const auto tiny = source / "rawlogs" / "tiny_room.rawlog";
  expectAllOrNothing({4000, 60000}, place,
                     {"run", tiny.string(), "-o", folder.file("out").string(), "--quiet", "--no-snapshot",
                      "--until", "2", "--record-detections", (place / "copy.rawlog").string()});
  std::filesystem::create_directories(folder.path() / "small");
  test::writeRawlog(folder.file("a.rawlog"), TinyRecording(20).records({true, false, true}));
  ASSERT_EQ(call(folder.path(),
                 {"run", folder.file("a.rawlog").string(), "-o", folder.file("small").string(), "--quiet"})
                .exit_code,
            0);
  std::filesystem::copy_file(folder.file("small/graph.g2o"), place / "graph.g2o");
  expectAllOrNothing(
      {400, 800}, place,
      {"optimize", (place / "graph.g2o").string(), "-o", (place / "graph.g2o").string(), "--quiet"});
  expectAllOrNothing(
      {400, 3000}, place,
      {"snapshot", folder.file("small/map.rgmap").string(), "-o", (place / "map.png").string()});
  expectAllOrNothing({400, 30000}, place,
                     {"simulate", (source / "rawlogs" / "tiny_handheld.json").string(), "-o",
                      (place / "world").string(), "--quiet"});
}

}  // namespace
}  // namespace roomgraph::test
