// SPDX-License-Identifier: BSD-3-Clause
// Keys change with everything that counts and with nothing else.
#include "run_keys.h"

#include <gmock/gmock.h>

#include "roomgraph/core/checksum.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

class Keys : public ::testing::Test {
 protected:
  void SetUp() override {
    needs.parameters = {{"a.b", "1"}, {"detection.models", folder.write("net.onnx", "weights").string()}};
    needs.objects = "[chair]";
    needs.files = {folder.file("net.onnx")};
    needs.detections = "detection.models=" + folder.file("net.onnx").string();
  }
  std::string key() { return runKey(recording, needs, variant, program, hashes); }
  std::string detections() { return detectionKey(recording, needs, program, hashes); }
  /// Whether `change` changes the keys of run and detections.
  template <class Change>
  std::pair<bool, bool> changes(Change change) {
    const auto before = std::pair(key(), detections());
    const auto kept = std::tuple(recording, program, needs, variant);
    change();
    const auto after = std::pair(key(), detections());
    std::tie(recording, program, needs, variant) = kept;
    return {before.first != after.first, before.second != after.second};
  }
  const TemporaryFolder folder;
  FileHashes hashes{nullptr, nullptr};
  RunNeeds needs;
  BatchVariant variant;
  std::string recording = "r", program = "p";
};

TEST_F(Keys, ChangeWithWhatCounts) {
  const std::pair both(true, true), run_only(true, false), none(false, false);
  EXPECT_EQ(changes([] {}), none);
  EXPECT_EQ(changes([&] { recording = "s"; }), both);
  EXPECT_EQ(changes([&] { program = "q"; }), both);
  EXPECT_EQ(changes([&] { needs.objects += "[sofa]"; }), both);
  EXPECT_EQ(changes([&] { needs.parameters["a.b"] = "2"; }), run_only);
  EXPECT_EQ(changes([&] { needs.parameters["a.c"] = "1"; }), run_only);
  EXPECT_EQ(changes([&] { needs.detections += "x"; }), std::pair(false, true));
  EXPECT_EQ(changes([&] { variant.poses = {"K=1"}; }), run_only);
  EXPECT_EQ(changes([&] { variant.name = "other"; }), none) << "a name is a name";
}

TEST_F(Keys, ANetworkCountsByItsBytesWhereverItLies) {
  const std::pair none(false, false);
  EXPECT_EQ(changes([&] {
              std::filesystem::create_directories(folder.file("x"));
              const auto elsewhere = folder.write("x/net.onnx", "weights");
              needs.parameters["detection.models"] = elsewhere.string();
              needs.detections = "detection.models=" + elsewhere.string();
              needs.files = {elsewhere};
            }),
            none);
  EXPECT_EQ(changes([&] { folder.write("net.onnx", "other weights"); }), std::pair(true, true));
}

TEST_F(Keys, WithoutANetworkNothingIsShared) {
  needs.detections.clear();
  EXPECT_EQ(detections(), "");
}

TEST_F(Keys, OfAnEvaluationAreThoseOfItsTruth) {
  TruthFiles truth{{"trajectory", folder.write("gt.txt", "1")}};
  JobFile jobs;
  const auto of = [&] { return evaluationKey(truth, jobs, program, hashes); };
  const std::string first = of();
  std::filesystem::copy_file(folder.file("gt.txt"), folder.file("gt2.txt"));
  truth["trajectory"] = folder.file("gt2.txt");
  EXPECT_EQ(of(), first);
  folder.write("gt2.txt", "23");
  EXPECT_NE(of(), first);
  truth["trajectory"] = folder.file("gt.txt");
  jobs.evaluation["trajectory"] = {"--interpolate"};
  EXPECT_NE(of(), first);
}

TEST_F(Keys, OfASimulationAreWorldSeedAndSimulator) {
  PlannedInput input;
  input.simulate = {folder.write("w.json", "{}").string(), "--seed", "1"};
  const std::string first = simulationKey(input, "s", hashes);
  EXPECT_NE(simulationKey(input, "t", hashes), first);
  folder.write("w.json", "{ }");
  EXPECT_NE(simulationKey(input, "s", hashes), first);
  folder.write("w.json", "{}");
  EXPECT_EQ(simulationKey(input, "s", hashes), first);
  input.simulate.back() = "2";
  EXPECT_NE(simulationKey(input, "s", hashes), first);
}

TEST_F(Keys, HashesAreThoseOfTheBytes) {
  const auto rawlog = folder.write("lab.rawlog", "abc");
  EXPECT_EQ(hashes.of(rawlog), sha256Of("abc"));
  EXPECT_EQ(hashes.ofRecording(rawlog), sha256Of("abc"));
  std::filesystem::create_directories(folder.file("lab_Images"));
  folder.write("lab_Images/1.jpg", "x");
  const std::string with_image = hashes.ofRecording(rawlog);
  EXPECT_NE(with_image, sha256Of("abc")) << "external images count";
  folder.write("lab_Images/2.jpg", "x");
  EXPECT_NE(hashes.ofRecording(rawlog), with_image);
}

// A catalogue remembers what was reckoned, and a changed file is reckoned again.
TEST_F(Keys, HashesAreRemembered) {
  Catalogue catalogue = Catalogue::forWriting(folder.file("c"));
  const auto file = folder.write("big", "abc");
  EXPECT_EQ(FileHashes(&catalogue, &catalogue).of(file), sha256Of("abc"));
  catalogue.rememberChecksum(file, stampOf(file), "remembered");
  EXPECT_EQ(FileHashes(&catalogue, &catalogue).of(file), "remembered");
  folder.write("big", "abcd");
  EXPECT_EQ(FileHashes(&catalogue, &catalogue).of(file), sha256Of("abcd"));
}

TEST_F(Keys, WhatChangedIsSaidInWords) {
  RunResult before;
  before.status = "complete";
  before.parameters = {{"a.b", "1"}, {"a.c", "1"}};
  RunResult now = before;
  now.parameters["a.c"] = "2";
  EXPECT_EQ(whatChanged(before, now), "the configuration has changed: a.c");
  now = before;
  now.program = now.key = "x";
  EXPECT_EQ(whatChanged(before, now), "the program has changed");
  now.input.sha256 = "y";
  EXPECT_EQ(whatChanged(before, now), "the recording has changed");
  before.status = "failed";
  before.reason = "no pose";
  EXPECT_EQ(whatChanged(before, now), "failed before: no pose");
}

TEST_F(Keys, EvaluationsAreThoseThatTheTruthAllows) {
  JobFile jobs;
  const auto names = [&](const TruthFiles& truth) {
    std::string out;
    for (const auto& step : evaluationSteps(truth, "/run", jobs)) out += step.report + " ";
    return out;
  };
  EXPECT_EQ(names({}), "");
  EXPECT_EQ(names({{"trajectory", "t"}}), "trajectory live ");
  EXPECT_EQ(names({{"camera_trajectory", "c"}, {"objects", "o"}, {"boxes", "b"}, {"map", "m"}}),
            "trajectory objects objects_live detections map ");
  const auto steps =
      evaluationSteps({{"camera_trajectory", "c"}, {"trajectory", "t"}, {"objects", "o"}}, "/run", jobs);
  EXPECT_THAT(steps[0].arguments, ::testing::ElementsAre("trajectory", "t", "/run/trajectory.tum"))
      << "the robot's counts more";
  EXPECT_THAT(steps[1].arguments, ::testing::ElementsAre("trajectory", "t", "/run/live.tum"));
  EXPECT_THAT(steps[2].arguments,
              ::testing::ElementsAre("objects", "o", "/run/landmarks.json", "--truth-trajectory", "t",
                                     "--trajectory", "/run/trajectory.tum"));
  jobs.evaluation = {{"trajectory", {"--interpolate"}}, {"objects", {"none"}}, {"live", {"none"}}};
  EXPECT_EQ(names({{"trajectory", "t"}, {"objects", "o"}}), "trajectory ");
  EXPECT_EQ(evaluationSteps({{"trajectory", "t"}}, "/run", jobs)[0].arguments.back(), "--interpolate");
}

}  // namespace
}  // namespace roomgraph::test
