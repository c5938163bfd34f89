// SPDX-License-Identifier: BSD-3-Clause
// Result files of `roomgraph run`: content against truth, repeatability, subsets of sensors.
#include <nlohmann/json.hpp>

#include "program.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using nlohmann::json;

struct TumPose {
  double t = 0;
  Eigen::Vector3d place;
  Eigen::Quaterniond turn;
};

std::vector<TumPose> tumOf(const std::filesystem::path& file) {
  std::vector<TumPose> poses;
  for (const auto& line : linesOf(contentOf(file))) {
    std::istringstream in(line);
    TumPose p;
    in >> p.t >> p.place.x() >> p.place.y() >> p.place.z() >> p.turn.x() >> p.turn.y() >> p.turn.z() >>
        p.turn.w();
    EXPECT_TRUE(in && (in >> std::ws).eof()) << file << ": " << line;
    EXPECT_NEAR(p.turn.norm(), 1, 1e-6) << line;
    EXPECT_TRUE(poses.empty() || p.t > poses.back().t) << "not in order of time: " << line;
    poses.push_back(p);
  }
  return poses;
}

class RunOutputTest : public ::testing::Test {
 protected:
  std::filesystem::path record(const std::vector<test::Object>& records) {
    test::writeRawlog(folder.file("tiny.rawlog"), records);
    return folder.file("tiny.rawlog");
  }
  CallResult run(const std::vector<std::string>& settings = {}) {
    std::vector<std::string> arguments{"run", folder.file("tiny.rawlog").string(), "-o", out.string(),
                                       "--quiet"};
    for (const auto& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    return call(folder.path(), arguments);
  }
  // Poses agree with the truth in the world of the robot's first pose.
  void expectTruth(double tolerance_m, double tolerance_rad) {
    for (const auto& pose : tumOf(out / "trajectory.tum")) {
      const Pose2 truth = recording.truth((pose.t - TinyRecording::kStart_s) / TinyRecording::kStep_s);
      EXPECT_LT((pose.place - Eigen::Vector3d(truth.x, truth.y, 0)).norm(), tolerance_m) << "at " << pose.t;
      EXPECT_LT(pose.turn.angularDistance(Eigen::Quaterniond(toPose3(truth).linear())), tolerance_rad);
    }
  }
  void expectMap() {
    const std::string pgm = contentOf(out / "map.pgm"), yaml = contentOf(out / "map.yaml");
    std::istringstream in(pgm);
    std::string magic;
    std::size_t width = 0, height = 0, top = 0;
    in >> magic >> width >> height >> top;
    EXPECT_EQ(magic, "P5");
    EXPECT_EQ(pgm.size(), static_cast<std::size_t>(in.tellg()) + 1 + width * height);
    for (const char* key :
         {"image: map.pgm", "resolution:", "origin:", "negate:", "occupied_thresh:", "free_thresh:"})
      EXPECT_THAT(yaml, ::testing::HasSubstr(key));
  }
  void expectGraph() {
    int vertices = 0, edges = 0;
    for (const auto& line : linesOf(contentOf(out / "graph.g2o"))) {
      vertices += line.starts_with("VERTEX_SE3:QUAT ");
      edges += line.starts_with("EDGE_SE3:QUAT ");
    }
    EXPECT_GT(vertices, 3);
    EXPECT_GE(edges, vertices - 1);
  }

  TemporaryFolder folder;
  std::filesystem::path out = folder.path() / "out";
  TinyRecording recording;
};

TEST_F(RunOutputTest, EveryFileIsThereAndSound) {
  record(recording.records({}));
  const CallResult result = run();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(tumOf(out / "trajectory.tum").size(), 24u);  // scans and frames share their stamps
  EXPECT_EQ(tumOf(out / "trajectory_camera.tum").size(), 12u);
  EXPECT_GE(linesOf(contentOf(out / "live.tum")).size(), 24u);
  expectTruth(0.02, 0.01);
  EXPECT_TRUE(json::parse(contentOf(out / "landmarks.json")).at("landmarks").is_array());
  for (const char* name : {"detections.jsonl", "associations.jsonl"}) {
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
    for (const auto& line : linesOf(contentOf(out / name))) EXPECT_TRUE(json::accept(line)) << line;
  }
  const json summary = json::parse(contentOf(out / "summary.json"));
  EXPECT_EQ(summary["counts"]["scans"], 24);
  EXPECT_EQ(summary["counts"]["frames"], 12);
  EXPECT_EQ(summary["counts"]["frames_lost"], 0);
  EXPECT_GT(summary["peak_memory_mb"].get<double>(), 1);
  EXPECT_FALSE(summary["timings"].empty());
  EXPECT_FALSE(summary["version"].get<std::string>().empty());
  expectMap();
  expectGraph();
  EXPECT_TRUE(contentOf(out / "snapshot.png").starts_with("\x89PNG\r\n"));
}

TEST_F(RunOutputTest, MapCanBeDrawnAgain) {
  record(recording.records({true, false, true}));
  ASSERT_EQ(run().exit_code, 0);
  const auto picture = folder.file("again.png");
  const CallResult result =
      call(folder.path(), {"snapshot", (out / "map.rgmap").string(), "-o", picture.string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, ::testing::HasSubstr(picture.string()));
  EXPECT_TRUE(contentOf(picture).starts_with("\x89PNG\r\n"));
  expectOneLine(call(folder.path(), {"snapshot", (out / "map.rgmap").string(), "-o", "picture.txt"}), 2,
                ::testing::HasSubstr("something.png"));
}

TEST_F(RunOutputTest, EffectiveConfigRepeatsTheRun) {
  record(recording.records({true, false, true}));
  ASSERT_EQ(run({"backend.node_distance_m=0.1"}).exit_code, 0);
  const std::string config = contentOf(out / "config.ini"), poses = contentOf(out / "trajectory.tum");
  EXPECT_THAT(config, ::testing::HasSubstr("node_distance_m = 0.1\n"));
  EXPECT_EQ(contentOf(out / "objects.ini"),
            contentOf(std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "objects.ini"));
  const auto repeated = folder.path() / "repeated";
  const CallResult again =
      call(folder.path(), {"run", folder.file("tiny.rawlog").string(), "-o", repeated.string(), "--quiet",
                           "--config", (out / "config.ini").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(contentOf(repeated / "trajectory.tum"), poses);
  EXPECT_EQ(contentOf(repeated / "config.ini"), config);
  const json summary = json::parse(contentOf(repeated / "summary.json"));
  EXPECT_EQ(summary["command"].back(), (out / "config.ini").string());
  EXPECT_FALSE(summary["revision"].get<std::string>().empty());
}

TEST_F(RunOutputTest, FilesAreRelativeToWhoNamesThem) {
  record(recording.records({true, false, true}));
  std::filesystem::create_directories(folder.path() / "settings");
  folder.write("settings/mine.ini", "[pipeline]\nobjects_file = chairs.ini\n");
  folder.write("settings/chairs.ini", "[armchair]\nlabels = armchair\nshape = cylinder\n");
  folder.write("here.ini", "[stool]\nlabels = stool\nshape = cylinder\n");
  const auto runMine = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "run",      folder.file("tiny.rawlog").string(),      "-o", out.string(), "--quiet",
        "--config", folder.file("settings/mine.ini").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CallResult result = call(folder.path(), arguments, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return contentOf(out / "objects.ini");
  };
  EXPECT_THAT(runMine({}), ::testing::HasSubstr("armchair"));
  EXPECT_THAT(runMine({"--set", "pipeline.objects_file=here.ini"}), ::testing::HasSubstr("stool"));
}

// A config of one's own needs no object database of one's own.
TEST_F(RunOutputTest, ShippedObjectsServeAnyConfig) {
  record(recording.records({true, false, true}));
  folder.write("mine.ini", "\xef\xbb\xbf[lidar]\nenabled = true\n");  // as editors on Windows write it
  const CallResult result =
      call(folder.path(), {"run", folder.file("tiny.rawlog").string(), "-o", out.string(), "--quiet",
                           "--config", folder.file("mine.ini").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(contentOf(out / "objects.ini"), ::testing::HasSubstr("[swivel_chair]"));
}

TEST_F(RunOutputTest, InputsInTheOutputFolderAreKept) {
  record(recording.records({true, false, true}));
  ASSERT_EQ(run().exit_code, 0);
  const auto refused = [&](const std::vector<std::string>& arguments) {
    const auto before = contentOf(out / "summary.json");
    expectOneLine(call(folder.path(), arguments), 2, ::testing::HasSubstr("choose another output folder"));
    EXPECT_EQ(contentOf(out / "summary.json"), before);
  };
  const std::string tiny = folder.file("tiny.rawlog").string();
  refused({"run", tiny, "-o", out.string(), "--config", (out / "config.ini").string()});
  refused({"run", tiny, "-o", out.string(), "--map", (out / "map.rgmap").string()});
  std::filesystem::copy_file(tiny, out / "map.rgmap", std::filesystem::copy_options::overwrite_existing);
  refused({"run", (out / "map.rgmap").string(), "-o", out.string()});
  EXPECT_EQ(contentOf(out / "map.rgmap"), contentOf(tiny));
}

TEST_F(RunOutputTest, NothingOfAnEarlierRunStays) {
  record(recording.records({true, false, true}));
  ASSERT_EQ(run().exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(out / "snapshot.png"));
  ASSERT_EQ(call(folder.path(),
                 {"run", folder.file("tiny.rawlog").string(), "-o", out.string(), "--quiet", "--no-snapshot"})
                .exit_code,
            0);
  EXPECT_FALSE(std::filesystem::exists(out / "snapshot.png"));
  EXPECT_FALSE(std::filesystem::exists(out / "roomgraph_unfinished"));
}

// No OpenGL on this machine, as far as the program can see.
TEST_F(RunOutputTest, ARunNeedsNoPicture) {
  record(recording.records({true, false, true}));
  setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
  const CallResult result = run(), picture = call(folder.path(), {"snapshot", (out / "map.rgmap").string(),
                                                                  "-o", folder.file("x.png").string()});
  unsetenv("__EGL_VENDOR_LIBRARY_DIRS");
  expectOneLine(result, 0, ::testing::HasSubstr("--no-snapshot"));
  EXPECT_FALSE(tumOf(out / "trajectory.tum").empty());
  EXPECT_FALSE(std::filesystem::exists(out / "snapshot.png"));
  expectOneLine(picture, 1, ::testing::HasSubstr("libegl1"));
}

TEST_F(RunOutputTest, AnySubsetOfTheSensorsWillDo) {
  record(recording.records({}));
  struct Case {
    std::vector<std::string> off;
    std::size_t poses;
    double tolerance_m;
  };
  const std::vector<Case> cases = {{{"lidar", "odometry"}, 12, 0.05},
                                   {{"tracking", "detection"}, 24, 0.02},
                                   {{"tracking", "detection", "odometry"}, 24, 0.02},
                                   {{"lidar"}, 12, 0.05},
                                   {{"lidar", "tracking"}, 12, 0.06},  // wheels only: 3 % of 0.9 m
                                   {{"lidar", "tracking", "detection"}, 24, 0.06}};
  for (const auto& [off, poses, tolerance_m] : cases) {
    std::vector<std::string> settings;
    for (const auto& source : off) settings.push_back(source + ".enabled=false");
    SCOPED_TRACE("without " + ::testing::PrintToString(off));
    const CallResult result = run(settings);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(tumOf(out / "trajectory.tum").size(), poses);
    expectTruth(tolerance_m, 0.03);
  }
}

TEST_F(RunOutputTest, ActionsAndSensoryFramesToo) {
  record(recording.actionRecords());
  const CallResult result = run();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(tumOf(out / "trajectory.tum").size(), 24u);
  EXPECT_GT(json::parse(contentOf(out / "summary.json"))["counts"]["odometry"].get<int>(), 20);
  expectTruth(0.02, 0.01);
}

TEST_F(RunOutputTest, SpanOfTimeIsKept) {
  record(recording.records({true, false, true}));
  ASSERT_EQ(call(folder.path(), {"run", folder.file("tiny.rawlog").string(), "-o", out.string(), "--quiet",
                                 "--from", "0.55", "--until", "1.05"})
                .exit_code,
            0);
  const auto poses = tumOf(out / "trajectory.tum");
  ASSERT_EQ(poses.size(), 5u);
  EXPECT_NEAR(poses.front().t, TinyRecording::kStart_s + 0.6, 1e-3);
  EXPECT_NEAR(poses.back().t, TinyRecording::kStart_s + 1.0, 1e-3);
}

}  // namespace
}  // namespace roomgraph::test
