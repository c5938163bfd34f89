// SPDX-License-Identifier: BSD-3-Clause
// Readers of boxes, detections and associations per frame.
#include "roomgraph/evaluation/frame_files.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;
using test::messageOf;
using test::TemporaryFolder;

TEST(FrameFiles, ReadsTrueBoxes) {
  const TemporaryFolder folder;
  const auto frames = readTrueFrames(folder.write("boxes.jsonl",
                                                  R"({"frame": 0, "t": 10.5, "objects": []}

{"frame": 1, "t": 10.6, "objects": [{"id": 4, "class": "other", "kind": "bin", "bbox": [1, 2, 3, 5], "visible": 0.25}]}
)"));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].t, 10.5);
  ASSERT_EQ(frames[1].boxes.size(), 1u);
  EXPECT_EQ(frames[1].boxes[0].id, 4);
  EXPECT_EQ(frames[1].boxes[0].kind, "bin");
  EXPECT_EQ(frames[1].boxes[0].box, (Box2{1, 2, 3, 5}));
  EXPECT_EQ(frames[1].boxes[0].visible, 0.25);
}

TEST(FrameFiles, ReadsDetections) {
  const TemporaryFolder folder;
  const auto frames = readDetections(folder.write(
      "d.jsonl", R"({"timestamp": 7, "boxes": [{"class": "sofa", "score": 0.5, "bbox": [0.5, 1, 2, 3]}]})"));
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].t, 7);
  EXPECT_EQ(frames[0].boxes.at(0).class_name, "sofa");
  EXPECT_EQ(frames[0].boxes.at(0).score, 0.5);
  EXPECT_EQ(frames[0].boxes.at(0).box.u_min, 0.5);
}

TEST(FrameFiles, ProbabilityOfTheDecisionIsTakenFromThePosterior) {
  const TemporaryFolder folder;
  const auto frames = readAssociations(folder.write(
      "a.jsonl",
      R"({"timestamp": 1, "measurements": [ {"class": "sofa", "bbox": [0,0,1,1], "landmark": 3, "new": false, "posterior": [{"landmark": 3, "p": 0.7}, {"landmark": "new", "p": 0.3}]}, {"class": "sofa", "bbox": [0,0,1,1], "landmark": 9, "new": true, "posterior": [{"landmark": 3, "p": 0.2}, {"landmark": "new", "p": 0.8}]}, {"class": "sofa", "bbox": [0,0,1,1], "landmark": 9, "new": false, "posterior": [{"landmark": 3, "p": 1}]}]})"));
  ASSERT_EQ(frames.size(), 1u);
  ASSERT_EQ(frames[0].boxes.size(), 3u);
  EXPECT_EQ(frames[0].boxes[0].probability, 0.7);
  EXPECT_EQ(frames[0].boxes[1].probability, 0.8);
  EXPECT_TRUE(frames[0].boxes[1].is_new);
  EXPECT_EQ(frames[0].boxes[1].landmark, 9);
  EXPECT_TRUE(std::isnan(frames[0].boxes[2].probability));
}

TEST(FrameFiles, EmptyRunsAreFineEmptyTruthIsNot) {
  const TemporaryFolder folder;
  const auto empty = folder.write("e.jsonl", "\n");
  EXPECT_TRUE(readDetections(empty).empty());
  EXPECT_TRUE(readAssociations(empty).empty());
  EXPECT_THAT(messageOf<InputError>([&] { readTrueFrames(empty); }), HasSubstr("e.jsonl: is empty"));
}

TEST(FrameFiles, BadLinesNameFileAndLine) {
  const TemporaryFolder folder;
  const auto short_box = folder.write("s.jsonl", R"({"timestamp": 1, "boxes": []}
{"timestamp": 2, "boxes": [{"class": "sofa", "score": 1, "bbox": [1, 2, 3]}]})");
  EXPECT_THAT(messageOf<InputError>([&] { readDetections(short_box); }),
              HasSubstr("s.jsonl:2: bbox must have 4 numbers"));
  EXPECT_THAT(messageOf<InputError>([&] { readTrueFrames(short_box); }), HasSubstr("s.jsonl:1: "));
  EXPECT_THAT(messageOf<InputError>([&] { readAssociations(folder.path() / "none.jsonl"); }),
              HasSubstr("none.jsonl: cannot be opened"));
  const auto p = folder.write(
      "p.jsonl",
      R"({"timestamp": 1, "measurements": [{"class": "sofa", "bbox": [0,0,1,1], "landmark": 3, "new": false, "posterior": [{"landmark": 3, "p": 1.5}]}]})");
  EXPECT_THAT(messageOf<InputError>([&] { readAssociations(p); }), HasSubstr("not in [0, 1]"));
}

TEST(FrameFiles, NearestFrameWithinTheLimit) {
  const FramesByTime frames(std::vector<DetectedFrame>{{1.0, {}}, {1.1, {}}, {1.1, {}}, {1.2, {}}});
  EXPECT_EQ(frames.nearest(1.1, 0.02), 1);
  EXPECT_EQ(frames.nearest(1.11, 0.02), 1);
  EXPECT_EQ(frames.nearest(1.19, 0.1), 3);
  EXPECT_EQ(frames.nearest(1.05, 0.02), -1);
  EXPECT_EQ(frames.nearest(1.2, 0), 3);
  EXPECT_EQ(FramesByTime(std::vector<DetectedFrame>{}).nearest(1, 1), -1);
}

// In any order, with equal stamps and equal distances: as by trying all, of which the first one that is nearest counts.
TEST(FrameFiles, NearestFrameIsThatOfTryingAll) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<DetectedFrame> frames;
    for (int i = 0; i < 12; ++i) frames.push_back({0.25 * static_cast<double>(random() % 16), {}});
    const FramesByTime by_time(frames);
    for (double t = -0.5; t < 4.5; t += 0.125) {
      int best = -1;
      for (int i = 0; i < 12; ++i) {
        const auto gap = [&](int at) { return std::abs(frames[static_cast<std::size_t>(at)].t - t); };
        if (gap(i) <= 0.5 && (best < 0 || gap(i) < gap(best))) best = i;
      }
      EXPECT_EQ(by_time.nearest(t, 0.5), best);
    }
  }
}

}  // namespace
}  // namespace roomgraph
