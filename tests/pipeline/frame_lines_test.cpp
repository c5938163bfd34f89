// SPDX-License-Identifier: BSD-3-Clause
// Lines of associations: whole ones, and those of sightings that were given up, in order of time.
#include "frame_lines.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace roomgraph::test {
namespace {

using nlohmann::json;

ObjectDecision decided(int landmark, const std::string& class_name, double probability) {
  ObjectDecision out;
  out.landmark = LandmarkId{landmark};
  out.seen.measurement.proposal.class_name = class_name;
  out.seen.measurement.detection.box = {1, 2, 3, 4.0 + landmark};
  out.association.probability = probability;
  out.association.posterior = {{LandmarkId{landmark}, probability}, {LandmarkId{}, 1 - probability}};
  return out;
}

// One frame in three holds two objects.
ObjectFrames framesOf(int count) {
  ObjectFrames out;
  for (int i = 0; i < count; ++i) {
    ObjectFrame frame{.frame = FrameId{i}, .t = 0.5 * i, .decisions = {decided(i, "sofa", 0.75)}};
    if (i % 3 == 0) frame.decisions.push_back(decided(100 + i, "door", 0.5));
    out.add(frame);
  }
  return out;
}

void giveUp(ObjectFrames& frames, const std::vector<std::size_t>& positions) {
  std::vector<FormerSighting> known;
  for (const std::size_t i : positions)
    for (const auto& decision : frames[i].decisions)
      known.push_back({.t = frames[i].t,
                       .class_name = decision.seen.measurement.proposal.class_name,
                       .box = decision.seen.measurement.detection.box,
                       .landmark = decision.landmark,
                       .probability = decision.association.probability});
  frames.giveUp(positions, known);
}

std::vector<json> associationsOf(const ObjectFrames& frames) {
  std::ostringstream out;
  writeAssociations(out, frames);
  std::istringstream in(out.str());
  std::vector<json> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
  return lines;
}

TEST(FrameLines, AFrameIsALine) {
  const ObjectFrames frames = framesOf(2);
  const auto lines = associationsOf(frames);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], json::parse(associationsLine(0, frames[0].decisions)));
  ASSERT_EQ(lines[0].at("measurements").size(), 2u);
  const json& door = lines[0].at("measurements")[1];
  EXPECT_EQ(door.at("class"), "door");
  EXPECT_EQ(door.at("landmark"), 100);
  EXPECT_EQ(door.at("bbox"), json({1.0, 2.0, 3.0, 104.0}));
  EXPECT_EQ(door.at("posterior"), json::parse(R"([{"landmark": 100, "p": 0.5}, {"landmark": "new", "p": 0.5}])"));
  EXPECT_FALSE(door.contains("given_up"));
  EXPECT_EQ(lines[1].at("timestamp"), 0.5);
}

TEST(FrameLines, SightingsThatWereGivenUpStandBetweenTheOthers) {
  ObjectFrames frames = framesOf(8);
  giveUp(frames, {1, 6, 7});
  giveUp(frames, {0, 2});  // those of 0 and 3
  ASSERT_EQ(frames.size(), 3u);
  const auto lines = associationsOf(frames);
  ASSERT_EQ(lines.size(), 8u);
  for (int i = 0; i < 8; ++i) {
    const json& line = lines[static_cast<std::size_t>(i)];
    const bool kept = i == 2 || i == 4 || i == 5;
    EXPECT_EQ(line.at("timestamp"), 0.5 * i);
    ASSERT_EQ(line.at("measurements").size(), i % 3 == 0 ? 2u : 1u) << i;
    for (const json& measurement : line.at("measurements")) {
      EXPECT_EQ(measurement.value("given_up", false), !kept) << i;
      EXPECT_EQ(measurement.contains("world"), kept) << i;
      EXPECT_EQ(measurement.at("new"), kept);  // first ones, as they were decided; those given up say nothing of it
    }
    const json& sofa = line.at("measurements")[0];
    EXPECT_EQ(sofa.at("landmark"), i);
    EXPECT_EQ(sofa.at("bbox")[3], 4.0 + i);
    EXPECT_EQ(sofa.at("posterior")[0], json::parse(R"({"landmark": )" + std::to_string(i) + R"(, "p": 0.75})"));
  }
}

}  // namespace
}  // namespace roomgraph::test
