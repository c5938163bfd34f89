// SPDX-License-Identifier: BSD-3-Clause
// A simulated drive to and fro in thirty metres of plain corridor: no loop is closed there, and it keeps its length.
#include <nlohmann/json.hpp>

#include "program.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;

TEST(PlainCorridorRun, ClosesNoLoopAndIsAsLongAsTheWheelsSay) {
  const TemporaryFolder folder;
  const auto at = [&](const char* name) { return folder.file(name).string(); };
  ASSERT_EQ(call(folder.path(), {"simulate", ROOMGRAPH_SOURCE_DIR "/worlds/plain_corridor.json", "-o", at("corridor")}).exit_code, 0);
  const auto run = call(folder.path(), {"run", at("corridor/plain_corridor.rawlog"), "-o", at("out"), "--quiet", "--no-report", "--no-snapshot"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto summary = nlohmann::json::parse(contentOf(folder.file("out/summary.json")));
  EXPECT_EQ(summary["counts"]["loop_closures"], 0);
  // The wheels slip by .2 m on the way: nothing shows it. What they are calibrated to in the first room holds in the corridor.
  ASSERT_EQ(call(folder.path(), {"evaluate", "trajectory", at("corridor/groundtruth_robot.txt"), at("out/trajectory.tum"), "--json", at("ate.json")}).exit_code, 0);
  EXPECT_LT(nlohmann::json::parse(contentOf(folder.file("ate.json")))["ate_rmse_m"], 0.25);
}

}  // namespace
}  // namespace roomgraph
