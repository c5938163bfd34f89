// SPDX-License-Identifier: BSD-3-Clause
// The engine's ini: the shipped one, MRPT's, and what is wrong in others.
#include "roomgraph/graphslam/engine_ini.h"

#include <gmock/gmock.h>

#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string problemOf(const std::filesystem::path& file) {
  try {
    readEngineIni(file, {});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(EngineIni, TheShippedOneNamesOurParts) {
  const EngineIni ini = readEngineIni(ROOMGRAPH_SOURCE_DIR "/share/mrpt/graphslam.ini", {});
  EXPECT_EQ(ini.parts.node, "CKeyPosesNRD");
  EXPECT_THAT(ini.parts.edges, ElementsAre("CScanClosuresERD", "CImageClosuresERD"));
  EXPECT_EQ(ini.parts.optimizer, "CFactorGraphGSO");
  EXPECT_EQ(ini.parts.dimensions, 2);
}

TEST(EngineIni, WithoutOurKeysTheDefaultsOfMrptsProgramHold) {
  const test::TemporaryFolder folder;
  const EngineIni ini =
      readEngineIni(folder.write("x.ini", "[GeneralConfiguration]\nsave_map = false\nsave_graph_fname = g.txt\n"), {});
  EXPECT_EQ(ini.parts.node, "CFixedIntervalsNRD");
  EXPECT_THAT(ini.parts.edges, ElementsAre("CICPCriteriaERD"));
  EXPECT_EQ(ini.parts.optimizer, "CLevMarqGSO");
  EXPECT_TRUE(ini.save_graph);
  EXPECT_FALSE(ini.save_map);
  EXPECT_EQ(ini.graph_file, "g.txt");
  EXPECT_EQ(ini.scene_file, "scene.3DScene");
}

TEST(EngineIni, WhatIsAskedForGoesBeforeTheIni) {
  const EngineIni ini = readEngineIni(ROOMGRAPH_SOURCE_DIR "/share/mrpt/graphslam.ini",
                                      {"CFixedIntervalsNRD", "CEmptyERD+CScanClosuresERD", "CLevMarqGSO", 3});
  EXPECT_EQ(ini.parts.node, "CFixedIntervalsNRD");
  EXPECT_THAT(ini.parts.edges, ElementsAre("CEmptyERD", "CScanClosuresERD"));
  EXPECT_EQ(ini.parts.optimizer, "CLevMarqGSO");
  EXPECT_EQ(ini.parts.dimensions, 3);
}

TEST(EngineIni, ErrorsNameFileAndKey) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(problemOf(folder.file("none.ini")), HasSubstr("none.ini: no such file"));
  const auto with = [&](const std::string& line) {
    return problemOf(folder.write("x.ini", "[GeneralConfiguration]\n" + line + "\n"));
  };
  EXPECT_THAT(with("save_map = perhaps"), HasSubstr("x.ini: [GeneralConfiguration] save_map = perhaps"));
  EXPECT_THAT(with("save_graph_fname = ../../graph"), HasSubstr("save_graph_fname = ../../graph: must be a file name"));
  EXPECT_THAT(with("optimizer = CLevMarq"), HasSubstr("optimizer = CLevMarq: there is none; known: CLevMarqGSO, "));
  EXPECT_THAT(with("dimensions = 5"), HasSubstr("dimensions = 5"));
}

}  // namespace
}  // namespace roomgraph
