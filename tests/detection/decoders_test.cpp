// SPDX-License-Identifier: BSD-3-Clause
// Network decoders against outputs written by hand; choice of a decoder; non-maximum suppression.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <opencv2/core.hpp>

#include "ade20k_decoder.h"
#include "darknet_decoder.h"
#include "errors_of.h"
#include "label_lists.h"
#include "nanodet_decoder.h"
#include "network_decoders.h"
#include "room_decoder.h"
#include "roomgraph/core/errors.h"
#include "suppress.h"
#include "yolox_decoder.h"

namespace roomgraph {

/// Decoders that recognise tables of 999 columns, as the one of a second plug-in for the same networks would.
class FirstOfTwo : public NetworkDecoder {
  DEFINE_MRPT_OBJECT(FirstOfTwo, roomgraph)
 public:
  std::string name() const override { return "zz_first"; }
  Preprocessing preprocessing() const override { return {}; }
  bool recognises(const NetworkOutputs& outputs, int) const override { return outputs.blobs[0].cols == 999; }
  std::vector<RawBox> decode(const NetworkOutputs&, const DecodingTask&) const override { return {}; }
};
IMPLEMENTS_MRPT_OBJECT(FirstOfTwo, NetworkDecoder, roomgraph)

class SecondOfTwo : public FirstOfTwo {
  DEFINE_MRPT_OBJECT(SecondOfTwo, roomgraph)
 public:
  std::string name() const override { return "zz_second"; }
};
IMPLEMENTS_MRPT_OBJECT(SecondOfTwo, FirstOfTwo, roomgraph)

class SameName : public FirstOfTwo {
  DEFINE_MRPT_OBJECT(SameName, roomgraph)
 public:
  std::string name() const override { return "yolox"; }
};
IMPLEMENTS_MRPT_OBJECT(SameName, FirstOfTwo, roomgraph)

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

void expectBox(const Box2& box, double u0, double v0, double u1, double v1) {
  EXPECT_NEAR(box.u_min, u0, 1e-3);
  EXPECT_NEAR(box.v_min, v0, 1e-3);
  EXPECT_NEAR(box.u_max, u1, 1e-3);
  EXPECT_NEAR(box.v_max, v1, 1e-3);
}

NetworkOutputs outputsOf(const cv::Mat& blob, cv::Size input, const std::string& file = "x.onnx") {
  return {file, input, {blob}};
}

/// What the decoder makes of one output; only outputs that it recognises are to give boxes.
template <class Decoder>
std::vector<RawBox> decoded(const cv::Mat& blob, cv::Size input, int classes, double min_score,
                            const std::vector<int>& wanted = {}) {
  const auto outputs = outputsOf(blob, input, std::is_same_v<Decoder, DarknetDecoder> ? "x.weights" : "x.onnx");
  const auto boxes = Decoder().decode(outputs, {classes, wanted, min_score});
  EXPECT_TRUE(boxes.empty() || Decoder().recognises(outputs, classes));
  return boxes;
}

// 64 x 64 input: 8x8 + 4x4 + 2x2 + 1 = 85 anchors for NanoDet, 84 for YOLOX.
TEST(RoomDecoderTest, BoxesAreDistancesFromTheCellsCentre) {
  constexpr int kClasses = 3, kCells = 40 * 30 + 20 * 15 + 10 * 8;  // of 320 x 240 px
  const int shape[] = {1, kCells, kClasses + 7};
  cv::Mat blob(3, shape, CV_32F, cv::Scalar(-9));
  cv::Mat table(kCells, kClasses + 7, CV_32F, blob.data);
  // Second level, row 3, column 5: centre (88, 56) px.
  float* row = table.ptr<float>(40 * 30 + 3 * 20 + 5);
  row[1] = 0.7f;
  const double sides[] = {24, 16, 48, 32};  // px
  for (int k = 0; k < 4; ++k) row[kClasses + k] = static_cast<float>(std::log(sides[k] / 16));
  const auto boxes = decoded<RoomDecoder>(blob, {320, 240}, kClasses, 0.3);
  ASSERT_EQ(boxes.size(), 1u);
  expectBox(boxes[0].box, 88 - 24, 56 - 16, 88 + 48, 56 + 32);
  EXPECT_EQ(boxes[0].class_index, 1);
  EXPECT_NEAR(boxes[0].score, 1 / (1 + std::exp(-0.7)), 1e-6);
  EXPECT_TRUE(decoded<RoomDecoder>(blob, {320, 240}, kClasses, 0.7).empty());
  EXPECT_FALSE(RoomDecoder().recognises(outputsOf(blob, {320, 240}), kClasses + 1));
  EXPECT_FALSE(RoomDecoder().recognises(outputsOf(blob, {320, 192}), kClasses));
}

TEST(Decoders, NanodetDistributionBecomesDistances) {
  cv::Mat output = cv::Mat::zeros(85, 2 + 32, CV_32FC1);
  float* row = output.ptr<float>(64 + 1 * 4 + 2);  // stride 16, row 1, column 2: centre (32, 16)
  row[1] = 0.8f;
  const int distance[] = {0, 1, 2, 7};                                          // strides
  for (const int side : {0, 1, 2, 3}) row[2 + side * 8 + distance[side]] = 60;  // all weight on one bin
  const auto boxes = decoded<NanodetDecoder>(output, {64, 64}, 2, 0.5);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(boxes[0].class_index, 1);
  EXPECT_NEAR(boxes[0].score, 0.8, 1e-6);
  expectBox(boxes[0].box, 32, 0, 64, 128);  // left 0, top 16, right 32, bottom 112
}

TEST(Decoders, NanodetExpectationOverTwoBins) {
  cv::Mat output = cv::Mat::zeros(85, 1 + 32, CV_32FC1);
  float* row = output.ptr<float>(84);  // the stride-64 anchor at (0, 0)
  row[0] = 0.9f;
  for (int side = 0; side < 4; ++side) {
    for (int bin = 0; bin < 8; ++bin) row[1 + side * 8 + bin] = -100;
    row[1 + side * 8 + 0] = std::log(3.f);  // 3/4 at 0, 1/4 at 1
    row[1 + side * 8 + 1] = 0;
  }
  const auto boxes = decoded<NanodetDecoder>(output, {64, 64}, 1, 0.5);
  ASSERT_EQ(boxes.size(), 1u);
  expectBox(boxes[0].box, -16, -16, 16, 16);
}

TEST(Decoders, NanodetRefusesForeignBlobs) {
  EXPECT_TRUE(decoded<NanodetDecoder>(cv::Mat::ones(84, 34, CV_32FC1), {64, 64}, 2, 0.1).empty());
  EXPECT_TRUE(decoded<NanodetDecoder>(cv::Mat::ones(85, 33, CV_32FC1), {64, 64}, 2, 0.1).empty());
  EXPECT_TRUE(decoded<NanodetDecoder>(cv::Mat(), {64, 64}, 2, 0.1).empty());
}

TEST(Decoders, YoloxOffsetsAndLogSizes) {
  cv::Mat output = cv::Mat::zeros(84, 5 + 3, CV_32FC1);
  float* row = output.ptr<float>(2 * 8 + 3);  // stride 8, row 2, column 3
  row[0] = 0.5f;
  row[1] = 0.25f;
  row[2] = std::log(2.f);
  row[3] = std::log(4.f);
  row[4] = 0.5f;
  row[7] = 0.9f;
  const auto boxes = decoded<YoloxDecoder>(output, {64, 64}, 3, 0.4);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(boxes[0].class_index, 2);
  EXPECT_NEAR(boxes[0].score, 0.45, 1e-6);
  expectBox(boxes[0].box, 28 - 8, 18 - 16, 28 + 8, 18 + 16);
  EXPECT_TRUE(decoded<YoloxDecoder>(output, {64, 64}, 3, 0.46).empty());
}

TEST(Decoders, DarknetRelativeBoxes) {
  cv::Mat output = cv::Mat::zeros(3, 5 + 2, CV_32FC1);
  output.row(1) = cv::Mat((cv::Mat_<float>(1, 7) << 0.5f, 0.5f, 0.25f, 0.5f, 0.9f, 0.6f, 0.1f)) * 1.0;
  output.at<float>(2, 6) = std::numeric_limits<float>::quiet_NaN();
  const auto boxes = decoded<DarknetDecoder>(output, {320, 160}, 2, 0.5);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(boxes[0].class_index, 0);
  expectBox(boxes[0].box, 120, 40, 200, 120);
}

TEST(Decoders, NonFiniteBoxesAreDropped) {
  cv::Mat output = cv::Mat::zeros(84, 6, CV_32FC1);
  float* row = output.ptr<float>(0);
  row[2] = 1000;  // exp overflows
  row[4] = row[5] = 1;
  EXPECT_TRUE(decoded<YoloxDecoder>(output, {64, 64}, 1, 0.5).empty());
}

cv::Mat blob4(int channels, int rows, int cols) {
  const int size[] = {1, channels, rows, cols};
  return cv::Mat(4, size, CV_32FC1, cv::Scalar(0));
}

TEST(Decoders, SegmentationComponentsOfTheWantedClass) {
  cv::Mat logits = blob4(3, 8, 10);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 10; ++x) {
      const bool first = x >= 1 && x <= 2 && y >= 2 && y <= 6, second = x >= 6 && x <= 8 && y >= 1 && y <= 4;
      if (first || second) *logits.ptr<float>(0, 2, y) = 0, logits.ptr<float>(0, 2, y)[x] = std::log(8.f);
      if (x == 4) logits.ptr<float>(0, 1, y)[x] = 5;  // another class
    }
  logits.ptr<float>(0, 2, 2)[8] = 0;  // a hole in the second component's corner
  const auto boxes = decoded<Ade20kDecoder>(logits, {100, 160}, 3, 0.5, {2});
  ASSERT_EQ(boxes.size(), 2u);
  const RawBox& second = boxes[0].box.u_min > 30 ? boxes[0] : boxes[1];
  const RawBox& first = boxes[0].box.u_min > 30 ? boxes[1] : boxes[0];
  expectBox(first.box, 10, 40, 30, 140);
  expectBox(second.box, 60, 20, 90, 100);
  EXPECT_NEAR(first.score, 0.8, 1e-5);  // 8 / (8 + 1 + 1)
  EXPECT_EQ(first.mask.size(), cv::Size(2, 5));
  EXPECT_EQ(cv::countNonZero(second.mask), 11);
  EXPECT_TRUE(decoded<Ade20kDecoder>(logits, {100, 160}, 3, 0.81, {2}).empty());
  EXPECT_TRUE(decoded<Ade20kDecoder>(logits, {100, 160}, 3, 0.5, {0, 1}).size() > 0) << "the other classes";
  EXPECT_TRUE(decoded<Ade20kDecoder>(cv::Mat::zeros(3, 3, CV_32FC1), {100, 160}, 3, 0.5, {2}).empty());
}

TEST(Decoders, SmallSegmentsAreLeftOut) {
  cv::Mat logits = blob4(2, 40, 50);  // 0.4 % of it: 8 pixels
  const auto paint = [&](int column, int pixels) {
    for (int y = 0; y < pixels; ++y) logits.ptr<float>(0, 1, 5 + y)[column] = 9;
  };
  paint(10, 7);
  EXPECT_TRUE(decoded<Ade20kDecoder>(logits, {50, 40}, 2, 0.5, {1}).empty());
  paint(30, 8);
  const auto boxes = decoded<Ade20kDecoder>(logits, {50, 40}, 2, 0.5, {1});
  ASSERT_EQ(boxes.size(), 1u);
  expectBox(boxes[0].box, 30, 5, 31, 13);
}

// Every output of each published network, by its shape and the number of classes it was trained for.
TEST(NetworkDecoders, OutputsAreRecognised) {
  const auto formatOf = [](const cv::Mat& blob, int classes, const std::string& file = "x.onnx") {
    const auto decoder = decoderFor(outputsOf(blob, {416, 416}, file), classes);
    return decoder ? decoder->name() : "none";
  };
  const auto batch = [](int rows, int columns) {
    const int size[] = {1, rows, columns};
    return cv::Mat(3, size, CV_32FC1, cv::Scalar(0));
  };
  EXPECT_EQ(formatOf(batch(3598, 112), 80), "nanodet");
  EXPECT_EQ(formatOf(batch(3549, 85), 80), "yolox");
  EXPECT_EQ(formatOf(cv::Mat::zeros(300, 85, CV_32FC1), 80, "x.weights"), "darknet");
  EXPECT_EQ(formatOf(blob4(32, 32, 32), 32), "ade20k");
  EXPECT_EQ(formatOf(batch(3598, 112), 79), "none");
  EXPECT_EQ(formatOf(batch(3598, 112), 80, "x.weights"), "none");
  EXPECT_EQ(formatOf(cv::Mat::zeros(10, 85, CV_8UC1), 80), "none");
  const int size[] = {2, 3598, 112};
  EXPECT_EQ(formatOf(cv::Mat(3, size, CV_32FC1, cv::Scalar(0)), 80), "none") << "two images";
}

TEST(NetworkDecoders, AreFoundByName) {
  std::vector<std::string> names;
  for (const auto& decoder : networkDecoders()) names.push_back(decoder->name());
  EXPECT_THAT(names, ::testing::ElementsAre("ade20k", "darknet", "nanodet", "room", "yolox"));
  for (const auto& name : names) {
    ASSERT_TRUE(decoderNamed(name)) << name;
    EXPECT_EQ(decoderNamed(name)->name(), name);
    EXPECT_EQ(decoderNamed(name)->segments(), name == "ade20k");
  }
  EXPECT_FALSE(decoderNamed("yolo"));
  EXPECT_EQ(knownFormats(), "auto, ade20k, darknet, nanodet, room, yolox");
}

// Changes the class registry for good, so it comes after the tests of the decoders that are shipped.
TEST(NetworkDecoders, TwoThatRecogniseOneOutputAreAnError) {
  mrpt::rtti::registerClass(CLASS_ID(FirstOfTwo));
  const auto outputs = outputsOf(cv::Mat::zeros(2, 999, CV_32FC1), {64, 64}, "folder/x.onnx");
  ASSERT_TRUE(decoderFor(outputs, 3));
  EXPECT_EQ(decoderFor(outputs, 3)->name(), "zz_first");
  mrpt::rtti::registerClass(CLASS_ID(SecondOfTwo));
  EXPECT_THAT(test::messageOf<ConfigError>([&] { decoderFor(outputs, 3); }),
              AllOf(HasSubstr("folder/x.onnx"), HasSubstr("zz_first and zz_second"), HasSubstr("x.onnx:zz_first")));
}

TEST(NetworkDecoders, TwoOfOneNameAreAnError) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a process of its own: this one keeps its registry
  const auto exitWithMessage = [] {
    mrpt::rtti::registerClass(CLASS_ID(SameName));
    try {
      networkDecoders();
    } catch (const ConfigError& error) {
      std::fputs(error.what(), stderr);
      std::_Exit(7);
    }
  };
  EXPECT_EXIT(exitWithMessage(), ::testing::ExitedWithCode(7),
              "format name 'yolox': roomgraph::SameName and roomgraph::YoloxDecoder");
}

TEST(Decoders, SuppressionIsPerClass) {
  const std::vector<RawBox> boxes{{{0, 0, 10, 10}, 0, 0.6, {}},
                                  {{1, 0, 11, 10}, 0, 0.9, {}},    // IoU 9/11 with the first
                                  {{1, 0, 11, 10}, 1, 0.7, {}},    // the same place, another class
                                  {{20, 0, 30, 10}, 0, 0.5, {}}};  // elsewhere
  EXPECT_EQ(suppressPerClass(boxes, 0.5), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(suppressPerClass(boxes, 0.9), (std::vector<int>{1, 2, 0, 3}));
  EXPECT_TRUE(suppressPerClass({}, 0.5).empty());
  EXPECT_EQ(suppressTwins(boxes, {1, 2, 3}, 0.75), (std::vector<int>{1, 3}));
  EXPECT_EQ(suppressTwins(boxes, {1, 2, 3}, 1), (std::vector<int>{1, 2, 3}));
}

TEST(Decoders, RivalsAreBoxesInTheSamePlaceOfNothingThatIsMapped) {
  const auto database = ObjectDatabase::fromText(
      "[chair]\nlabels = chair\n[sofa]\nlabels = couch\n[person]\nlabels = person\nlandmark = false\n");
  const auto detection = [](const std::string& name, double u, double score) {
    return Detection{.box = {u, 0, u + 10, 10}, .class_name = name, .score = score};
  };
  std::vector<Detection> found{detection("chair", 0, 0.5), detection("sofa", 0, 0.9),
                               detection("chair", 20, 0.4), detection("person", 20, 0.7),
                               detection("chair", 40, 0.3)};
  setRivals(found, {detection("", 1, 0.6), detection("", 0, 0.2), detection("", 22, 0.8)}, database);
  EXPECT_EQ(found[0].rival_score, 0.6) << "the best of two; a sofa is mapped";
  EXPECT_EQ(found[2].rival_score, 0.7) << "a person; the other one covers two thirds";
  EXPECT_EQ(found[3].rival_score, 0) << "a person is no landmark";
  EXPECT_EQ(found[4].rival_score, 0) << "alone";
}

TEST(Decoders, CocoLabels) {
  EXPECT_STREQ(cocoLabel(0), "person");
  EXPECT_STREQ(cocoLabel(56), "chair");
  EXPECT_STREQ(cocoLabel(57), "couch");
  EXPECT_STREQ(cocoLabel(79), "toothbrush");
  EXPECT_STREQ(cocoLabel(80), "");
  EXPECT_STREQ(cocoLabel(-1), "");
}

}  // namespace
}  // namespace roomgraph
