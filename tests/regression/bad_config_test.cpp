// SPDX-License-Identifier: BSD-3-Clause
// Command-line and configuration errors: exit code, one clear line, suggestions.
#include "program.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class BadConfig : public ::testing::Test {
 protected:
  CallResult runWith(const std::string& assignment) {
    return call(folder.path(),
                {"run", "any.rawlog", "-o", (folder.path() / "out").string(), "--set", assignment});
  }
  TemporaryFolder folder;
};

TEST_F(BadConfig, MisspeltKeySuggestsTheRightOne) {
  expectOneLine(runWith("tracking.enabld=false"), 2,
                AllOf(HasSubstr("enabld"), HasSubstr("did you mean 'enabled'")));
  expectOneLine(runWith("trackin.enabled=false"), 2,
                AllOf(HasSubstr("trackin"), HasSubstr("did you mean 'tracking'")));
}

TEST_F(BadConfig, ValueOutOfRangeSaysWhatIsAllowed) {
  expectOneLine(runWith("backend.window_nodes=0"), 2,
                AllOf(HasSubstr("window_nodes"), HasSubstr("'0'"), HasSubstr("[2, 100]")));
  expectOneLine(runWith("tracking.enabled=maybe"), 2, AllOf(HasSubstr("maybe"), HasSubstr("true or false")));
  expectOneLine(runWith("lidar.noise_per_m=fast"), 2, AllOf(HasSubstr("noise_per_m"), HasSubstr("fast")));
}

TEST_F(BadConfig, NothingToMoveBy) {
  expectOneLine(call(folder.path(), {"run", "any.rawlog", "-o", "out", "--set", "tracking.enabled=false",
                                     "--set", "lidar.enabled=false", "--set", "odometry.enabled=false"}),
                2, HasSubstr("switched off"));
}

TEST_F(BadConfig, AssignmentWithoutItsForm) {
  expectOneLine(runWith("tracking"), 2, HasSubstr("section.key=value"));
}

TEST_F(BadConfig, UnknownClassListsTheKnown) {
  expectOneLine(runWith("detection.class=Foo"), 2, AllOf(HasSubstr("Foo"), HasSubstr("DnnDetector")));
  expectOneLine(runWith("scan_loop_closing.class=Foo"), 2,
                AllOf(HasSubstr("Foo"), HasSubstr("SubmapLoopCloser")));
}

TEST_F(BadConfig, UnknownPlugIn) {
  expectOneLine(runWith("pipeline.plugins=libnone.so"), 2,
                AllOf(HasSubstr("plug-in"), HasSubstr("libnone.so")));
  const auto text = folder.write("text.so", "no library");
  expectOneLine(runWith("pipeline.plugins=" + text.string()), 2, HasSubstr("text.so"));
}

TEST_F(BadConfig, NetworkFileThatDoesNotLoad) {
  expectOneLine(runWith("detection.models=none.onnx"), 3, HasSubstr("none.onnx"));
  const auto garbage = folder.write("garbage.onnx", std::string(5000, 'x'));
  folder.write("labels.txt", "chair\n");
  expectOneLine(runWith("detection.models=" + garbage.string()), 3, HasSubstr("garbage.onnx"));
}

TEST_F(BadConfig, FilesThatAreMissingOrBroken) {
  const auto runFile = [&](const std::filesystem::path& config) {
    return call(folder.path(), {"run", "any.rawlog", "-o", "out", "--config", config.string()});
  };
  expectOneLine(runFile(folder.path() / "none.ini"), 2, HasSubstr("none.ini"));
  expectOneLine(runFile(folder.path()), 2, HasSubstr("is a folder"));
  expectOneLine(runFile(folder.write("broken.ini", "[pipeline\nx\n")), 2, HasSubstr("broken.ini"));
  expectOneLine(runFile(folder.write("key.ini", "[pipeline]\nlookahead=1\n")), 2,
                AllOf(HasSubstr("key.ini"), HasSubstr("lookahead_s")));
  expectOneLine(runFile(folder.write("objects.ini", "[pipeline]\nobjects_file = absent.ini\n")), 2,
                HasSubstr("absent.ini"));
}

TEST(Misuse, SaysWhatIsWrongAndPrintsTheUsage) {
  TemporaryFolder folder;
  const auto misuse = [&](const std::vector<std::string>& arguments) {
    return call(folder.path(), arguments);
  };
  const auto usage = HasSubstr("Usage: roomgraph");
  expectOneLine(misuse({}), 2, usage);
  expectOneLine(misuse({"runn"}), 2,
                AllOf(usage, HasSubstr("unknown command 'runn'"), HasSubstr("did you mean 'run'")));
  expectOneLine(misuse({"--fast"}), 2, AllOf(usage, HasSubstr("--fast")));
  expectOneLine(misuse({"run"}), 2, AllOf(HasSubstr("INPUT"), HasSubstr("Usage: roomgraph run")));
  expectOneLine(misuse({"run", "x.rawlog", "-o", "out", "--fast"}), 2, AllOf(HasSubstr("--fast"), usage));
  expectOneLine(misuse({"run", "x.rawlog", "-o", "out", "--threads", "-1"}), 2,
                AllOf(HasSubstr("--threads"), HasSubstr("must be a number, 0 or more")));
  expectOneLine(misuse({"run", "x.rawlog", "-o", "out", "--from", "soon"}), 2, HasSubstr("--from"));
  expectOneLine(misuse({"evaluate"}), 2, HasSubstr("Usage: roomgraph evaluate"));
}

TEST(Misuse, HelpAndVersionAreNoErrors) {
  TemporaryFolder folder;
  const CallResult help = call(folder.path(), {"--help"}), run = call(folder.path(), {"run", "--help"}),
                   version = call(folder.path(), {"--version"});
  for (const auto& outcome : {help, run, version}) {
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err, "");
  }
  for (const char* command : {"run", "import", "info", "evaluate", "snapshot"})
    EXPECT_THAT(help.out, HasSubstr(command));
  EXPECT_THAT(run.out, HasSubstr("--set"));
  EXPECT_THAT(version.out, ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+ \\([-0-9a-z]+\\)\n"));
}

}  // namespace
}  // namespace roomgraph::test
