// SPDX-License-Identifier: BSD-3-Clause
// Files of roomgraph read by MRPT's own programs (rawlog-edit, graph-slam).
#include <cstdio>

#include "program.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "temporary_folder.h"

// MRPT's own programs, which know nothing of our library, on files that we write (package mrpt-apps).
namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kRoomForOthers = fs::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rawlog";

/// What a command prints; its end is "exit N".
std::string outputOf(const std::string& command) {
  FILE* pipe = popen(("( " + command + " ) 2>&1; echo exit $?").c_str(), "r");
  std::string text;
  char block[4096];
  while (const std::size_t got = fread(block, 1, sizeof block, pipe)) text.append(block, got);
  pclose(pipe);
  return text;
}

bool installed(const std::string& program) {
  return outputOf("command -v " + program).ends_with("exit 0\n");
}

/// Times of the boxes in a rawlog, s.
std::vector<double> boxTimes(const fs::path& file) {
  std::vector<double> times;
  RawlogReader reader(file);
  while (const auto record = reader.next())
    if (std::holds_alternative<std::shared_ptr<CObservationDetections>>(*record))
      times.push_back(timeOf(*record));
  EXPECT_EQ(reader.statistics().warning, "");
  return times;
}

class RawlogEdit : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!installed("rawlog-edit")) GTEST_SKIP() << "rawlog-edit is not installed (package mrpt-apps)";
  }
  void edit(const std::string& arguments) {
    const std::string text = outputOf("rawlog-edit " + arguments);
    EXPECT_THAT(text, ::testing::EndsWith("exit 0\n"));
    EXPECT_THAT(text, ::testing::Not(HasSubstr("xception"))) << arguments;
  }
  TemporaryFolder folder;
};

TEST_F(RawlogEdit, SeesEveryRecord) {
  const std::string text = outputOf("rawlog-edit --info -i " + kRoomForOthers.string());
  EXPECT_THAT(text, ::testing::ContainsRegex("number of objects *: 203"));  // 41 + 40 + 81, and 41 with boxes
  EXPECT_THAT(text, HasSubstr(" 41 /5.000 /8.000"));
}

TEST_F(RawlogEdit, CutsAndFilters) {
  const auto cut = folder.file("cut.rawlog"), fewer = folder.file("fewer.rawlog");
  edit("--cut --from-time 1700000001.9 --to-time 1700000004.1 -i " + kRoomForOthers.string() + " -o " + cut.string());
  const auto times = boxTimes(cut);
  ASSERT_EQ(times.size(), 11u);
  EXPECT_NEAR(times.front(), 1700000002, 1e-3);
  EXPECT_NEAR(times.back(), 1700000004, 1e-3);
  edit("--remove-label LIDAR,ODOMETRY -i " + kRoomForOthers.string() + " -o " + fewer.string());
  EXPECT_EQ(boxTimes(fewer), boxTimes(kRoomForOthers));
}

TEST_F(RawlogEdit, ExternalImagesGiveTheSameMap) {
  const auto outside = folder.file("outside.rawlog");
  edit("--externalize -i " + kRoomForOthers.string() + " -o " + outside.string());
  ASSERT_TRUE(fs::is_directory(folder.file("outside_Images")));
  for (const auto& [input, output] : {std::pair{kRoomForOthers, "a"}, {outside, "b"}})
    ASSERT_EQ(call(folder.path(),
                   {"run", input.string(), "-o", folder.file(output).string(), "--quiet", "--no-snapshot"})
                  .exit_code,
              0);
  for (const char* name :
       {"detections.jsonl", "trajectory.tum", "associations.jsonl", "graph.g2o", "map.pgm"}) {
    EXPECT_FALSE(contentOf(folder.file("a") / name).empty()) << name;
    EXPECT_TRUE(contentOf(folder.file("a") / name) == contentOf(folder.file("b") / name)) << name;
  }
}

TEST_F(RawlogEdit, MrptOptimisesThePlanarGraph) {
  ASSERT_EQ(call(folder.path(), {"run", kRoomForOthers.string(), "-o", folder.file("out").string(), "--quiet",
                                 "--no-snapshot", "--set", "backend.planar_graph=true"})
                .exit_code,
            0);
  const std::string graph = (folder.file("out") / "graph.g2o").string();
  int vertices = 0;
  for (const auto& line : linesOf(contentOf(graph))) vertices += line.starts_with("VERTEX_SE2 ");
  EXPECT_THAT(outputOf("graph-slam --2d --info -i " + graph),
              ::testing::ContainsRegex("in VERTEX2/3 entries. *: " + std::to_string(vertices)));
  EXPECT_THAT(outputOf("graph-slam --2d --levmarq -i " + graph + " -o " + folder.file("best.graph").string()),
              ::testing::EndsWith("exit 0\n"));
  EXPECT_TRUE(fs::exists(folder.file("best.graph")));
}

}  // namespace
}  // namespace roomgraph::test
