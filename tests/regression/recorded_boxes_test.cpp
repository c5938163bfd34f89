// SPDX-License-Identifier: BSD-3-Clause
// Runs on a recording that contains detections: objects, warnings, graph in the plane.
#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"
#include "roomgraph/backend/g2o_file.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

const fs::path kRoomWithBoxes = fs::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rawlog";

class RecordedBoxesRun : public ::testing::Test {
 protected:
  CallResult run(const fs::path& input, const std::vector<std::string>& settings = {}) {
    std::vector<std::string> arguments{"run", input.string(), "-o", out.string(), "--quiet", "--no-snapshot"};
    for (const auto& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    return call(folder.path(), arguments);
  }
  json landmarks() const { return json::parse(contentOf(out / "landmarks.json")); }
  std::map<std::string, std::string> results() const {
    std::map<std::string, std::string> files;
    for (const char* name :
         {"landmarks.json", "detections.jsonl", "trajectory.tum", "associations.jsonl", "graph.g2o"})
      files[name] = contentOf(out / name);
    return files;
  }

  TemporaryFolder folder;
  fs::path out = folder.file("out");
};

TEST_F(RecordedBoxesRun, NeedsNoOptions) {
  const CallResult plain = run(kRoomWithBoxes);
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(plain.err, "");
  EXPECT_THAT(plain.out, HasSubstr("3 objects"));
  EXPECT_EQ(landmarks().at("landmarks").size(), 3u);
  const auto files = results();
  ASSERT_EQ(run(kRoomWithBoxes, {"detection.class=RecordedDetector"}).exit_code, 0);
  EXPECT_TRUE(results() == files) << "the class that it chooses gives the same";
}

TEST_F(RecordedBoxesRun, WithoutBoxesTheShippedNetworkRuns) {
  const auto input = folder.file("lab.rawlog");
  test::writeRawlog(input, TinyRecording(6).records({}));
  const CallResult result = run(input);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("room_detector: room_detector\n"));
  EXPECT_EQ(linesOf(contentOf(out / "detections.jsonl")).size(), 3u) << "it ran on every image";
  EXPECT_EQ(run(input, {"detection.enabled=false"}).err, "");
  const CallResult named = run(input, {"detection.class=DnnDetector"});
  EXPECT_THAT(named.out, HasSubstr("no network, so no objects")) << "who names a class is told by that class";
  test::writeRawlog(input, TinyRecording(6).records({true, false, true}));
  EXPECT_EQ(run(input).err, "") << "no images";
}

TEST_F(RecordedBoxesRun, BoxesThatStartLateAreNotWaitedFor) {
  auto records = TinyRecording(4).records({false, true, true});
  while (records.size() < 20001) records.push_back(test::makeOdometry(1001, 0, 0, 0));
  const auto input = folder.file("long.rawlog");
  test::writeRawlog(input, records);
  EXPECT_THAT(run(input).out, HasSubstr("room_detector: room_detector\n"));
  EXPECT_THAT(run(input, {"detection.class=RecordedDetector"}).out, Not(HasSubstr("room_detector")));
}

TEST_F(RecordedBoxesRun, BoxesOfOtherTimesAreWarnedAbout) {
  ASSERT_EQ(run(kRoomWithBoxes).exit_code, 0);
  std::string shifted;
  for (const auto& line : linesOf(contentOf(out / "detections.jsonl"))) {
    json boxes = json::parse(line);
    boxes["timestamp"] = boxes["timestamp"].get<double>() + 1000;
    shifted += boxes.dump() + "\n";
  }
  const auto input = folder.file("lab.rawlog");
  test::writeRawlog(input, TinyRecording(6).records({}));
  const CallResult result = run(input, {"detection.file=" + folder.write("late.jsonl", shifted).string()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(linesOf(result.err), ElementsAre(HasSubstr("none of the 41 images with recorded boxes")));
}

TEST_F(RecordedBoxesRun, LandmarksSayWhereTheyComeFromAndWhenTheyWereSeen) {
  ASSERT_EQ(run(kRoomWithBoxes).exit_code, 0);
  const json file = landmarks();
  EXPECT_EQ(file["frame"], "world");
  EXPECT_EQ(file["recording"], "tiny_room.rawlog");
  EXPECT_FALSE(file["version"].get<std::string>().empty());
  std::map<int, std::pair<double, double>> seen;
  for (const auto& line : linesOf(contentOf(out / "associations.jsonl"))) {
    const json frame = json::parse(line);
    const double t = frame["timestamp"];
    for (const auto& measurement : frame["measurements"])
      seen.try_emplace(measurement["landmark"].get<int>(), t, t).first->second.second = t;
  }
  ASSERT_EQ(file["landmarks"].size(), 3u);
  for (const auto& landmark : file["landmarks"]) {
    EXPECT_EQ(landmark["first_seen"], seen.at(landmark["id"]).first);
    EXPECT_EQ(landmark["last_seen"], seen.at(landmark["id"]).second);
    EXPECT_GT(landmark["last_seen"], landmark["first_seen"]);
  }
}

TEST_F(RecordedBoxesRun, PosesOfTheGraphAreOnTheTrajectory) {
  ASSERT_EQ(run(kRoomWithBoxes).exit_code, 0);
  std::set<std::string> stamps;
  for (const auto& line : linesOf(contentOf(out / "trajectory.tum")))
    stamps.insert(line.substr(0, line.find(' ')));
  int count = 0, vertices = 0;
  for (const auto& line : linesOf(contentOf(out / "graph.g2o"))) {
    vertices += line.starts_with("VERTEX");
    if (!line.starts_with("# STAMP ")) continue;
    ++count;
    EXPECT_TRUE(stamps.contains(line.substr(line.rfind(' ') + 1))) << line;
  }
  EXPECT_GT(count, 10);
  EXPECT_GT(vertices, count) << "landmarks have no stamp";
}

// The graph in the plane has the optimum of the one in space, and keeps times and names when it is optimised.
TEST_F(RecordedBoxesRun, PlanarGraph) {
  // Where scans were lost, stiff local maps of images turn tilts, which only space has, into places.
  const std::string steps = "backend.local_map_nodes=0";
  ASSERT_EQ(run(kRoomWithBoxes, {steps}).exit_code, 0);
  auto spatial = std::move(std::get<FactorGraph>(loadG2o(out / "graph.g2o").graph));
  ASSERT_TRUE(spatial.optimize(SolveOptions{100, 1e-12}).usable);
  ASSERT_EQ(run(kRoomWithBoxes, {steps, "backend.planar_graph=true"}).exit_code, 0);
  const CallResult optimized = call(folder.path(), {"optimize", (out / "graph.g2o").string(), "-o",
                                                    folder.file("best.g2o").string(), "--quiet"});
  ASSERT_EQ(optimized.exit_code, 0) << optimized.err;
  EXPECT_THAT(optimized.out, HasSubstr("2D, "));
  EXPECT_THAT(optimized.out, HasSubstr(" landmarks, "));
  const G2oContent before = loadG2o(out / "graph.g2o"), after = loadG2o(folder.file("best.g2o"));
  EXPECT_EQ(after.times, before.times);
  const auto& planar = std::get<PlanarGraph>(after.graph);
  EXPECT_EQ(planar.landmarks.size(), spatial.landmarks());
  EXPECT_GT(planar.landmarks.size(), 2u);
  ASSERT_EQ(planar.poses.size(), spatial.poses() + spatial.landmarks());
  for (const auto& [id, pose] : planar.poses) {
    const auto name = planar.landmarks.find(id);
    const Pose2 other = name == planar.landmarks.end() ? planarPart(spatial.pose(id)) : [&] {
      const auto& place = spatial.landmark(name->second.id).position;
      return Pose2{place.x(), place.y(), pose.yaw};  // not every yaw was measured
    }();
    EXPECT_LT(std::hypot(pose.x - other.x, pose.y - other.y), 1e-3) << id;
    EXPECT_LT(std::abs(wrapAngle(pose.yaw - other.yaw)), 1e-4) << id;
  }
}

}  // namespace
}  // namespace roomgraph::test
