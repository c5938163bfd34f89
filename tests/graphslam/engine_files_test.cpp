// SPDX-License-Identifier: BSD-3-Clause
// Result files of an engine: read back by the program's own readers.
#include "roomgraph/graphslam/engine_files.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "roomgraph/core/errors.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

TEST(EngineFiles, NoNameTwiceAndTheSummaryLast) {
  const auto names = engineFileNames({});
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(names.back(), "summary.json");
  EXPECT_THAT(names, ::testing::Contains("output_graph.graph"));
}

TEST(EngineFiles, TheTrajectoryComesBack) {
  const test::TemporaryFolder folder;
  const Pose3 pose = poseFromYpr(1, -2, 0.5, 0.3, 0.1, -0.2);
  writeTrajectory(folder.file("t.tum"), {{1000.25, Pose3::Identity()}, {1000.5, pose}});
  const Trajectory back = readTrajectory(folder.file("t.tum")).trajectory;
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back.poses()[1].t, 1000.5);
  EXPECT_TRUE(back.poses()[1].pose.isApprox(pose, 1e-5));
  EXPECT_THROW(writeTrajectory("/nowhere/t.tum", {}), RunError);
}

TEST(EngineFiles, ObjectsAndSummaryHoldWhatTheyWereGiven) {
  const test::TemporaryFolder folder;
  writeObjects(folder.file("o.json"), {{LandmarkId{4}, {"chair", {1, 2, 0}, 0.5, {0.5, 0.4, 0.9}, 3}}});
  const auto objects = nlohmann::json::parse(folder.read("o.json"))["landmarks"];
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0]["id"], 4);
  EXPECT_EQ(objects[0]["class"], "chair");
  EXPECT_EQ(objects[0]["y"], 2);
  EXPECT_EQ(objects[0]["size_wdh"][2], 0.9);
  EXPECT_EQ(objects[0]["nodes"], 3);
  EXPECT_EQ(objects[0]["has_yaw"], false);
  EngineRequest request;
  request.rawlog = "a\xff.rawlog";  // not UTF-8
  EngineOutcome outcome;
  outcome.nodes = 7;
  outcome.warnings = {"late"};
  writeEngineSummary(folder.file("s.json"), request, outcome);
  const auto summary = nlohmann::json::parse(folder.read("s.json"));
  EXPECT_EQ(summary["nodes"], 7);
  EXPECT_EQ(summary["warnings"][0], "late");
  EXPECT_EQ(summary["interrupted"], false);
}

}  // namespace
}  // namespace roomgraph
