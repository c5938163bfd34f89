// SPDX-License-Identifier: BSD-3-Clause
// Unusable and damaged inputs on the command line: exit codes, messages, what is still used.
#include "program.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class BadInput : public ::testing::Test {
 protected:
  CallResult run(const std::filesystem::path& input, const std::filesystem::path& output = {}) {
    return call(folder.path(), {"run", input.string(), "-o", (output.empty() ? out : output).string(),
                                "--quiet", "--no-snapshot"});
  }
  std::size_t posesWritten() { return linesOf(contentOf(out / "trajectory.tum")).size(); }

  TemporaryFolder folder;
  std::filesystem::path out = folder.path() / "out";
  TinyRecording recording{10};
};

TEST_F(BadInput, FilesThatAreNoRawlog) {
  const std::vector<std::filesystem::path> bad = {
      folder.path() / "none.rawlog", folder.write("empty.rawlog", ""),
      folder.write("text.rawlog", std::string(3000, 'x')), folder.path()};
  for (const auto& file : bad) {
    expectOneLine(run(file), 3, HasSubstr(file.filename().string()));
    expectOneLine(call(folder.path(), {"info", file.string()}), 3, HasSubstr(file.filename().string()));
  }
}

TEST_F(BadInput, OtherCommandsNameTheirFilesToo) {
  const std::string text = folder.write("text.txt", "no data\n").string(),
                    none = (folder.path() / "none").string();
  expectOneLine(call(folder.path(), {"snapshot", none, "-o", "x.png"}), 3, HasSubstr(none));
  expectOneLine(call(folder.path(), {"snapshot", text, "-o", "x.png"}), 3, HasSubstr(text));
  expectOneLine(call(folder.path(), {"evaluate", "trajectory", none, text}), 3, HasSubstr(none));
  expectOneLine(call(folder.path(), {"evaluate", "trajectory", text, text}), 3, HasSubstr(text));
  expectOneLine(call(folder.path(), {"import", "tum", none, "-o", (folder.path() / "x.rawlog").string()}), 3,
                HasSubstr(none));
}

TEST_F(BadInput, TruncatedRawlogIsUsedUpToTheDamage) {
  const auto records = recording.records({true, false, true});
  std::string bytes;
  std::vector<std::size_t> ends;
  for (const auto& record : records) ends.push_back((bytes += test::bytesOf(record)).size());
  // Odometry and scan in turn: six whole pairs, and half of the odometry of the seventh.
  const std::size_t end = ends[11];
  test::writeBytes(folder.file("cut.rawlog"), bytes.substr(0, (end + ends[12]) / 2));
  const CallResult result = run(folder.file("cut.rawlog"));
  expectOneLine(result, 0, AllOf(HasSubstr("warning"), HasSubstr(std::to_string(end))));
  EXPECT_EQ(posesWritten(), 6u);
}

TEST_F(BadInput, TruncatedGzipIsUsedUpToTheDamage) {
  test::writeRawlog(folder.file("whole.rawlog"), recording.records({true, false, true}));
  const std::string bytes = test::readBytes(folder.file("whole.rawlog"));
  test::writeBytes(folder.file("cut.rawlog"), bytes.substr(0, bytes.size() / 2));
  expectOneLine(run(folder.file("cut.rawlog")), 0, HasSubstr("warning"));
  EXPECT_GE(posesWritten(), 2u);
  EXPECT_LT(posesWritten(), 10u);
}

// The reason names the class, of which a byte was damaged: JSON would refuse it.
TEST_F(BadInput, AReasonThatIsNoTextIsStillReported) {
  std::string first, rest;
  for (const auto& record : recording.records({true, false, true}))
    (first.empty() ? first : rest) += test::bytesOf(record);
  std::string broken = test::bytesOf(recording.images(3));
  const auto at = broken.find("CPose3D");
  ASSERT_NE(at, std::string::npos);
  broken[at + 2] = '\x94';
  test::writeBytes(folder.file("x.rawlog"), first + broken + rest);
  const CallResult result = run(folder.file("x.rawlog"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(posesWritten(), 10u);
  EXPECT_TRUE(std::filesystem::exists(out / "summary.json"));
  EXPECT_EQ(call(folder.path(), {"info", folder.file("x.rawlog").string()}).exit_code, 0);
}

TEST_F(BadInput, RawlogWithoutUsableSensors) {
  const auto comment = mrpt::obs::CObservationComment::Create();
  comment->timestamp = mrpt::Clock::fromDouble(5);
  test::writeRawlog(folder.file("talk.rawlog"), {comment, comment, comment});
  expectOneLine(run(folder.file("talk.rawlog")), 3,
                AllOf(HasSubstr("talk.rawlog"), HasSubstr("no usable record of a camera")));
}

TEST_F(BadInput, MissingExternalImagesAreCountedAndNamed) {
  auto records = recording.records({true, false, true});
  for (int i = 0; i < 4; ++i) {
    const auto images = recording.images(i);
    images->intensityImage.setExternalStorage("gone_" + std::to_string(i) + ".png");
    records.push_back(images);
  }
  test::writeRawlog(folder.file("external.rawlog"), records);
  const CallResult result = run(folder.file("external.rawlog"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  int lines = 0;
  for (const auto& line : linesOf(result.out)) lines += line.find("image missing") != std::string::npos;
  EXPECT_EQ(lines, 1) << result.out;
  EXPECT_THAT(result.out, HasSubstr("4 x image missing"));
  EXPECT_THAT(result.out, HasSubstr("gone_0.png"));
  EXPECT_EQ(posesWritten(), 10u);
}

TEST_F(BadInput, OutputFolderThatCannotBeMade) {
  test::writeRawlog(folder.file("good.rawlog"), recording.records({true, false, true}));
  const auto file = folder.write("file", "");
  expectOneLine(run(folder.file("good.rawlog"), file / "out"), 1, HasSubstr((file / "out").string()));
  expectOneLine(run(folder.file("good.rawlog"), file), 1, HasSubstr(file.string()));
}

TEST_F(BadInput, SpanBeyondTheEndHasNothingToUse) {
  test::writeRawlog(folder.file("good.rawlog"), recording.records({true, false, true}));
  expectOneLine(call(folder.path(), {"run", folder.file("good.rawlog").string(), "-o", out.string(),
                                     "--quiet", "--from", "100"}),
                3, HasSubstr("good.rawlog: nothing between 100 s and the end (0.9 s)"));
  expectOneLine(call(folder.path(), {"run", folder.file("good.rawlog").string(), "-o", out.string(), "--from",
                                     "5", "--until", "2"}),
                2, HasSubstr("--from is not before --until"));
}

TEST_F(BadInput, OdometryAloneIsNoRecordingUnlessThatWasMeant) {
  test::writeRawlog(folder.file("wheels.rawlog"), recording.records({false, false, true}));
  expectOneLine(run(folder.file("wheels.rawlog")), 3, HasSubstr("no usable record of a camera"));
  EXPECT_EQ(call(folder.path(), {"run", folder.file("wheels.rawlog").string(), "-o", out.string(), "--quiet",
                                 "--set", "tracking.enabled=false", "--set", "lidar.enabled=false"})
                .exit_code,
            0);
}

}  // namespace
}  // namespace roomgraph::test
