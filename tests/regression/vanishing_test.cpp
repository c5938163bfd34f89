// SPDX-License-Identifier: BSD-3-Clause
// Recording, output folder and disk that go away in the middle of a run: one line, former results, and what
// was done is not lost.
#include <signal.h>

#include <chrono>
#include <thread>

#include "program.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A run with former results in its folder, which is stopped when it is well under way.
class Vanishing : public ::testing::Test {
 protected:
  static constexpr int kSteps = 1500;

  void SetUp() override {
    test::writeRawlog(folder.file("short.rawlog"), TinyRecording(20).records({true, false, true}));
    test::writeRawlog(recording, TinyRecording(kSteps).records({true, false, true}), false);
    ASSERT_EQ(call(folder.path(), words("short.rawlog")).exit_code, 0);
    former = contentOf(out / "trajectory.tum");
  }
  std::vector<std::string> words(const std::string& input) const {
    // Without a detector nobody looks for boxes in the recording before the run begins.
    return {
        "run",   folder.file(input).string(), "-o", out.string(), "--quiet", "--no-snapshot", "--no-report",
        "--set", "detection.enabled=false"};
  }
  /// Runs the long recording with a pause in the middle, in which `change` is made.
  CallResult runWith(const std::function<void()>& change,
                     const std::vector<std::string>& variables = {}) const {
    Program program(folder.path(), words("long.rawlog"), fs::current_path(), variables);
    for (int i = 0; i < 3000; ++i) {
      std::error_code none_yet;
      if (fs::file_size(out / "roomgraph_unfinished" / "live.tum", none_yet) > 10000 && !none_yet) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    kill(program.pid(), SIGSTOP);
    change();
    // The next look at recording and folder comes within a second.
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    kill(program.pid(), SIGCONT);
    return program.wait();
  }
  void expectToGoOn() const {
    const CallResult resumed = call(folder.path(), {"run", "--resume", out.string(), "--quiet"});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(linesOf(contentOf(out / "trajectory.tum")).size(), static_cast<std::size_t>(kSteps));
    EXPECT_FALSE(fs::exists(out / "roomgraph_checkpoint"));
  }

  TemporaryFolder folder;
  const fs::path out = folder.file("out"), recording = folder.file("long.rawlog");
  std::string former;
};

TEST_F(Vanishing, TheRecordingIsRemoved) {
  const fs::path moved = folder.file("moved");
  const CallResult result = runWith([&] { fs::rename(recording, moved); });
  expectOneLine(result, 1, HasSubstr(recording.string() + ": vanished while it was replayed"));
  EXPECT_EQ(contentOf(out / "trajectory.tum"), former);
  EXPECT_EQ(call(folder.path(), {"run", "--resume", out.string(), "--quiet"}).exit_code, 3) << "not yet back";
  fs::rename(moved, recording);
  expectToGoOn();
}

TEST_F(Vanishing, TheRecordingIsCut) {
  const std::string whole = contentOf(recording);
  const auto time = fs::last_write_time(recording);
  const CallResult result = runWith([&] { fs::resize_file(recording, whole.size() - 1000); });
  expectOneLine(result, 1,
                AllOf(HasSubstr("was cut while it was replayed"), HasSubstr(std::to_string(whole.size()))));
  EXPECT_EQ(contentOf(out / "trajectory.tum"), former);
  expectOneLine(call(folder.path(), {"run", "--resume", out.string(), "--quiet"}), 2,
                HasSubstr("size of the recording is"));
  std::ofstream(recording, std::ios::binary) << whole;
  fs::last_write_time(recording, time);
  expectToGoOn();
}

TEST_F(Vanishing, TheOutputFolderIsRemoved) {
  const fs::path moved = folder.file("moved");
  const CallResult result = runWith([&] { fs::rename(out, moved); });
  expectOneLine(result, 1, HasSubstr("output folder " + out.string() + ": vanished"));
  EXPECT_FALSE(fs::exists(out));
  EXPECT_EQ(contentOf(moved / "trajectory.tum"), former);
  fs::rename(moved, out);
  expectToGoOn();
}

#ifdef ROOMGRAPH_FAILING_READS
// What a broken disk or a network drive that is gone says is not the end of the recording.
TEST_F(Vanishing, TheRecordingCannotBeReadOn) {
  const auto half = std::to_string(fs::file_size(recording) / 2);
  const CallResult result =
      call(folder.path(), words("long.rawlog"), fs::current_path(),
           {"LD_PRELOAD=" ROOMGRAPH_FAILING_READS, "ROOMGRAPH_FAILING_FILE=" + recording.string(),
            "ROOMGRAPH_FAILING_FROM=" + half});
  expectOneLine(result, 1,
                AllOf(HasSubstr(recording.string() + ": read error"), HasSubstr("Input/output error")));
  EXPECT_EQ(contentOf(out / "trajectory.tum"), former);
  expectToGoOn();
}
#endif

}  // namespace
}  // namespace roomgraph::test
