// SPDX-License-Identifier: BSD-3-Clause
// Lost, closed and redirected standard streams of the program.
#include <cstdlib>

#include "program.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::filesystem::path kRoomToStream = std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs/tiny_room.rawlog";

class StandardStreams : public ::testing::Test {
 protected:
  /// The program in a shell, with redirections of its own; stderr is kept.
  CallResult shell(const std::string& before, const std::string& arguments) {
    const auto errors = folder.file("stderr.txt");
    const std::string line =
        before + "'" + ROOMGRAPH_PROGRAM + "' " + arguments + " 2>'" + errors.string() + "'";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, "", contentOf(errors)};
  }
  TemporaryFolder folder;
};

TEST_F(StandardStreams, OutputThatIsLostIsAFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "missing: /dev/full";
  const auto message = HasSubstr("standard output: writing failed");
  for (const std::string command : {"--help", "config-reference", "--version"})
    expectOneLine(shell("", command + " >/dev/full"), 1, message);
  const CallResult info = shell("", "info '" + kRoomToStream.string() + "' >/dev/full");
  EXPECT_EQ(info.exit_code, 1);
  EXPECT_THAT(info.err, message);
}

TEST_F(StandardStreams, ClosedStreamsAreNoFailureAndNoFileTakesTheirPlace) {
  EXPECT_EQ(shell("", "--help >&- <&-").exit_code, 0);
  const auto report = folder.file("report.json");
  EXPECT_EQ(
      shell("", "info '" + kRoomToStream.string() + "' --json '" + report.string() + "' >&- <&-").exit_code,
      0);
  EXPECT_TRUE(contentOf(report).starts_with("{")) << "nothing that was printed went into it";
}

TEST_F(StandardStreams, RawlogsAreReadFromFilesOnly) {
  expectOneLine(shell("cat '" + kRoomToStream.string() + "' | ", "info /dev/stdin >/dev/null"), 3,
                AllOf(HasSubstr("/dev/stdin"), HasSubstr("pipe or device")));
  EXPECT_EQ(shell("", "info /dev/stdin >/dev/null <'" + kRoomToStream.string() + "'").exit_code, 0);
}

}  // namespace
}  // namespace roomgraph::test
