// SPDX-License-Identifier: BSD-3-Clause
// A simulated flat mapped with the object classes of a home, against the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using nlohmann::json;

const std::string kHome = ROOMGRAPH_SOURCE_DIR "/objects_home.ini";

double gap(const json& landmark, const json& truth) {
  return std::hypot(landmark["x"].get<double>() - truth["x"].get<double>(),
                    landmark["y"].get<double>() - truth["y"].get<double>());
}

// The nearest landmark of the object's class; null when there is none.
const json* landmarkOf(const json& truth, const json& landmarks) {
  const json* nearest = nullptr;
  for (const json& landmark : landmarks)
    if (landmark["class"] == truth["class"] && (!nearest || gap(landmark, truth) < gap(*nearest, truth)))
      nearest = &landmark;
  return nearest;
}

// Half a turn makes no difference to a table.
double yawError(const json& landmark, const json& truth) {
  const double periods = truth["class"] == "table" ? 2 : 1;
  return std::abs(std::remainder(periods * (landmark["yaw"].get<double>() - truth["yaw"].get<double>()), 2 * M_PI)) /
         periods;
}

TEST(HomeObjects, AFlatIsMappedAsItIs) {
  const TemporaryFolder folder;
  const CallResult simulated =
      call(folder.path(), {"simulate", ROOMGRAPH_SOURCE_DIR "/worlds/flat.json", "-o", folder.file("flat").string()});
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  const CallResult mapped = call(folder.path(), {"run", folder.file("flat/flat.rawlog").string(), "-o", folder.file("out").string(), "--set",
                                                 "pipeline.objects_file=" + kHome});
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  const json truth = json::parse(contentOf(folder.file("flat/objects.json")))["objects"];
  const json landmarks = json::parse(contentOf(folder.file("out/landmarks.json")))["landmarks"];
  ASSERT_EQ(truth.size(), 4u);
  EXPECT_EQ(landmarks.size(), 4u) << landmarks.dump(1);
  for (const json& object : truth) {
    SCOPED_TRACE(object.dump());
    const json* landmark = landmarkOf(object, landmarks);
    ASSERT_TRUE(landmark) << landmarks.dump(1);
    EXPECT_LT(gap(*landmark, object), 0.15);
    EXPECT_LT(yawError(*landmark, object), 0.15);
    for (int axis = 0; axis < 3; ++axis)  // width, depth, height
      EXPECT_NEAR((*landmark)["size_wdh"][axis].get<double>(), object["size_wdh"][axis].get<double>(), 0.15) << axis;
  }
}

}  // namespace
}  // namespace roomgraph::test
