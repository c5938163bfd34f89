// SPDX-License-Identifier: BSD-3-Clause
// Detections through bytes, and networks that need not run where a result store has their boxes.
#include "detection_bytes.h"

#include <gmock/gmock.h>

#include <map>
#include <opencv2/core.hpp>

#include "auto_detector.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/result_store.h"
#include "temporary_folder.h"
#include "tiny_network.h"

namespace roomgraph {
namespace {

using Found = Outcome<std::vector<Detection>>;

void expectSame(const Detection& a, const Detection& b) {
  for (const auto side : {&Box2::u_min, &Box2::v_min, &Box2::u_max, &Box2::v_max})
    EXPECT_EQ(a.box.*side, b.box.*side);
  EXPECT_EQ(a.class_name, b.class_name);
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.track, b.track);
  EXPECT_EQ(a.carried, b.carried);
  EXPECT_EQ(a.rival_score, b.rival_score);
  EXPECT_EQ(a.rival_label, b.rival_label);
  ASSERT_EQ(a.mask.size(), b.mask.size());
  if (!a.mask.empty()) {
    EXPECT_EQ(cv::countNonZero(a.mask != b.mask), 0);
  }
}

TEST(DetectionBytes, NothingIsLost) {
  cv::Mat mask(57, 33, CV_8UC1);
  cv::RNG(5).fill(mask, cv::RNG::UNIFORM, 0, 2);
  mask *= 255;
  Detection door{{10.1 / 3, 20.7 / 7, 36.6, 59.9}, "door", "Tür", 0.1 + 0.2, mask, TrackId{4}};
  Detection chair{{100, 200, 1e-300, 400}, "swivel_chair", "", 0.4, {}, {}, true, 1.0 / 3, "bench"};
  const auto back = detectionsFrom(bytesOf(Found(std::vector<Detection>{door, chair})));
  ASSERT_TRUE(back.ok());
  ASSERT_EQ(back->size(), 2u);
  expectSame((*back)[0], door);
  expectSame((*back)[1], chair);
}

// Each of these masks is three numbers: together they would be 2 GB.
TEST(DetectionBytes, MasksOfOneImageAreNotLargerThanImagesAre) {
  Detection large{{0, 0, 1, 1}, "door", "door", 0.5, cv::Mat(4096, 8192, CV_8UC1, cv::Scalar(255))};
  const auto back = detectionsFrom(bytesOf(Found(std::vector<Detection>(60, large))));
  ASSERT_TRUE(back.ok());
  ASSERT_EQ(back->size(), 60u);
  std::size_t pixels = 0;
  for (const auto& detection : *back) pixels += detection.mask.total();
  EXPECT_EQ(pixels, std::size_t{1} << 26);
}

// A byte of a flag that is neither 0 nor 1 is a flag that is set.
TEST(DetectionBytes, AFlagIsOneWhateverItsByte) {
  std::string bytes = bytesOf(Found(std::vector<Detection>{{{1, 2, 3, 4}, "door", "door", 0.5}}));
  ASSERT_EQ(bytes[0], 1);
  bytes[0] = static_cast<char>(128);
  EXPECT_EQ(detectionsFrom(bytes)->size(), 1u);
}

TEST(DetectionBytes, EveryBeginningOfThemIsRefused) {
  const std::string good = bytesOf(Found(std::vector<Detection>{{{1, 2, 3, 4}, "door", "door", 0.5}}));
  // MRPT takes a part of a number for the number when it stands at the end.
  for (std::size_t size = 0; size + sizeof(std::uint32_t) <= good.size(); ++size)
    EXPECT_ANY_THROW(detectionsFrom(good.substr(0, size))) << size;
}

TEST(DetectionBytes, NoBoxesAreNotTheSameAsNoAnswer) {
  const auto none = detectionsFrom(bytesOf(Found(std::vector<Detection>{})));
  EXPECT_TRUE(none.ok());
  EXPECT_TRUE(none->empty());
  const auto failed = detectionsFrom(bytesOf(Found::failure("no colour image")));
  EXPECT_FALSE(failed.ok());
  EXPECT_EQ(failed.reason(), "no colour image");
}

/// Answers with what a test put into it, and notes what is kept.
struct MadeUpResults : ResultStore {
  std::map<double, std::string> known, kept;
  std::optional<std::string> recall(std::string_view name, double t) override {
    EXPECT_EQ(name, "boxes");
    const auto found = known.find(t);
    return found == known.end() ? std::optional<std::string>() : found->second;
  }
  void keep(std::string_view, double t, std::string_view bytes) override { kept[t] = bytes; }
};

TEST(DetectionBytes, ANetworkRunsOnlyWhereItsBoxesAreNotKnown) {
  const test::TemporaryFolder folder;
  const ObjectDatabase classes = ObjectDatabase::fromText("[swivel_chair]\nlabels = chair\n");
  AutoDetector detector;
  Config::fromText("[detection]\nmodels = " + test::writeTinyNetwork(folder, 80).string() + "\n", "test")
      .read("detection", detector);
  detector.setDatabase(classes);
  detector.prepare();
  MadeUpResults results;
  const Detection chair{{1, 2, 3, 4}, "swivel_chair", "chair", 0.75};
  results.known[7] = bytesOf(Found(std::vector<Detection>{chair}));
  detector.setResultStore(results);
  Frame frame;
  frame.color = cv::Mat(48, 64, CV_8UC3, cv::Scalar(90, 90, 90));
  frame.camera = {64, 48, 50, 50, 32, 24, {}};
  frame.t = 7;
  const auto recalled_boxes = detector.detect(frame);
  ASSERT_TRUE(recalled_boxes.ok());
  ASSERT_EQ(recalled_boxes->size(), 1u) << "the network itself sees nothing";
  expectSame(recalled_boxes->front(), chair);
  frame.t = 8;
  const auto seen = detector.detect(frame);
  ASSERT_TRUE(seen.ok());
  EXPECT_TRUE(seen->empty());
  ASSERT_EQ(results.kept.size(), 1u);
  EXPECT_EQ(results.kept.begin()->first, 8);
  EXPECT_TRUE(detectionsFrom(results.kept.at(8))->empty());
}

}  // namespace
}  // namespace roomgraph
