// SPDX-License-Identifier: BSD-3-Clause
// The commands import carmen, rtabmap and openloris: exit codes, one line for each error; a log of a rawlog
// gives its trajectory.
#include "../regression/program.h"
#include "carmen_maker.h"
#include "openloris_maker.h"
#include "roomgraph/observations/rawlog_writer.h"
#include "rtabmap_maker.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::HasSubstr;

// Largest distance between two trajectories of the same stamps.
double farthest(const std::string& a, const std::string& b) {
  std::istringstream left(a), right(b);
  double most = 0, pose_a[8], pose_b[8];
  int count = 0;
  const auto read = [](std::istream& in, double* pose) {
    for (int i = 0; i < 8; ++i)
      if (!(in >> pose[i])) return false;
    return true;
  };
  for (; read(left, pose_a) && read(right, pose_b); ++count) {
    EXPECT_NEAR(pose_a[0], pose_b[0], 1e-5);
    most = std::max(most, std::hypot(pose_a[1] - pose_b[1], pose_a[2] - pose_b[2], pose_a[3] - pose_b[3]));
  }
  EXPECT_EQ(count, 40) << "one for each scan";
  return most;
}

TEST(ImportCommand, CarmenLogOfARawlogGivesItsTrajectory) {
  const TemporaryFolder folder;
  const auto log = folder.write("room.log", carmenLog(recordsIn(kTinyRoom)));
  const auto rawlog = folder.file("room.rawlog").string();
  const auto imported = call(folder.path(), {"import", "carmen", log.string(), "-o", rawlog, "--pose",
                                             "ROBOTLASER1=0.05,0,0.25,0,0,0"});
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_EQ(imported.out, "ROBOTLASER1: 360 beams over 360.0 deg, less than 8 m\nodometry: ODOM\n" + rawlog +
                              ": 81 'ODOMETRY', 40 'ROBOTLASER1'\n");
  const auto original = folder.file("original.rawlog").string();
  RawlogWriter writer(original);
  for (const auto& record : recordsIn(kTinyRoom))
    if (record->sensorLabel == "LIDAR" || record->sensorLabel == "ODOMETRY") writer.write(*record);
  writer.finish();
  for (const auto& [input, name] : {std::pair(original, "original"), {rawlog, "imported"}}) {
    const auto run = call(folder.path(), {"run", input, "-o", folder.file(name).string(), "--no-snapshot",
                                          "--no-report", "--quiet"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  EXPECT_LT(farthest(contentOf(folder.file("original/trajectory.tum")),
                     contentOf(folder.file("imported/trajectory.tum"))),
            1e-3);
}

TEST(ImportCommand, CarmenErrorsAreOneLineWithTheirCode) {
  const TemporaryFolder folder;
  const auto log = folder.write("x.log", "ODOM 0 0 0 0 0 0 100 h 1\nODOM 1 0 0 0 0 0 101 h 2\n").string();
  const std::string rawlog = folder.file("y.rawlog").string();
  const auto import = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"import", "carmen"});
    return call(folder.path(), words);
  };
  expectOneLine(import({log}), 2, HasSubstr("--output"));
  expectOneLine(import({kTinyRoom, "-o", rawlog}), 3, HasSubstr("no message of a CARMEN log"));
  expectOneLine(import({folder.file("no.log").string(), "-o", rawlog}), 3, HasSubstr("no such file"));
  expectOneLine(import({log, "-o", log}), 2, HasSubstr("is read by this import"));
  expectOneLine(import({log, "-o", "/nowhere/y.rawlog"}), 1, HasSubstr("there is no folder /nowhere"));
  expectOneLine(import({log, "-o", rawlog, "--pose", "FLASER=1"}), 2, HasSubstr("--pose FLASER=1"));
  expectOneLine(import({log, "-o", rawlog, "--truth", "corrected"}), 2, HasSubstr("no corrected poses"));
  EXPECT_FALSE(std::filesystem::exists(rawlog));
  const auto odometry_only = import({log, "-o", rawlog});
  EXPECT_EQ(odometry_only.exit_code, 0) << odometry_only.err;
  EXPECT_THAT(odometry_only.err, HasSubstr("warning: no sweeps in it, only odometry"));
  EXPECT_THAT(import({"--help"}).out, HasSubstr("roomgraph import carmen intel.log -o intel.rawlog"));
}

TEST(ImportCommand, RtabmapTellsWhatItDidAndItsErrors) {
  const TemporaryFolder folder;
  const std::string rawlog = folder.file("y.rawlog").string();
  const auto database =
      writeDatabase(folder.file("x.db"), {smallNode(1, 1.7e9), smallNode(2, 1.7e9 + 1)}).string();
  const auto import = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"import", "rtabmap"});
    return call(folder.path(), words);
  };
  expectOneLine(import({kTinyRoom, "-o", rawlog}), 3, HasSubstr("is no database of RTAB-Map, or damaged"));
  expectOneLine(import({database, "-o", rawlog, "--session", "4"}), 2, HasSubstr("has no session 4"));
  expectOneLine(import({database, "-o", database}), 2, HasSubstr("is read by this import"));
  EXPECT_FALSE(std::filesystem::exists(rawlog));
  const auto done = import({database, "-o", rawlog});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "version 0.20.16, session 0: 2 nodes\n" + rawlog + ": 2 'ODOMETRY', 2 'RGBD'\n");
  const auto told = call(folder.path(), {"info", rawlog});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("on robot  x 0.200 y 0.000 z 0.800 m"));
}

TEST(ImportCommand, OpenlorisTellsWhatItDidAndItsErrors) {
  const TemporaryFolder folder;
  const std::string rawlog = folder.file("y.rawlog").string();
  const auto sequence = writeSequence(folder, recordsIn(kTinyRoom)).string();
  const auto import = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"import", "openloris"});
    return call(folder.path(), words);
  };
  expectOneLine(import({folder.file("no").string(), "-o", rawlog}), 3, HasSubstr("no such folder"));
  expectOneLine(import({sequence, "-o", rawlog, "--camera", "eye"}), 2, HasSubstr("give FX,FY,CX,CY"));
  expectOneLine(import({sequence, "-o", sequence + "/odom.txt"}), 2, HasSubstr("is read by this import"));
  EXPECT_FALSE(std::filesystem::exists(rawlog));
  const auto done = import({sequence, "-o", rawlog});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, rawlog + ": 41 'D400', 81 'ODOMETRY'\n" + folder.file("y.groundtruth.txt").string() +
                          ": ground truth, poses of the robot (base_link)\n");
  EXPECT_EQ(done.err, "");
}

}  // namespace
}  // namespace roomgraph
