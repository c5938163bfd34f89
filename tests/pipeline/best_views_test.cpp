// SPDX-License-Identifier: BSD-3-Clause
// BestViews: the largest well-fitting box wins, hindsight moves pictures, borders are cut.
#include "roomgraph/pipeline/best_views.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

namespace roomgraph::test {
namespace {

using nlohmann::json;

std::vector<unsigned char> fromBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out.push_back(static_cast<unsigned char>(bits >> count & 255));
  }
  return out;
}

class Views : public ::testing::Test {
 protected:
  ObjectDecision decision(int landmark, const Box2& box, double score, bool carried = false) const {
    ObjectDecision out;
    out.landmark = LandmarkId{landmark};
    out.seen.measurement.detection.box = box;
    out.seen.measurement.detection.carried = carried;
    out.seen.measurement.proposal.score = score;
    return out;
  }

  // Left half blue, right half red.
  void show(int frame, const std::vector<ObjectDecision>& decisions) {
    Frame image;
    image.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar(200, 0, 0));
    image.color.colRange(320, 640) = cv::Scalar(0, 0, 200);
    StepReport report{.kind = StepReport::Kind::kFrame, .t = 0.1 * frame, .frame = FrameId{frame}};
    report.decisions = decisions;
    report.image = &image;
    views_.onStep(report);
    frames_.push_back({.frame = FrameId{frame}, .t = 0.1 * frame, .decisions = decisions});
  }

  std::map<int, json> lines() const {
    std::map<int, json> out;
    std::istringstream in(views_.text(frames_));
    for (std::string line; std::getline(in, line);) {
      const json view = json::parse(line);
      out[view.at("id").get<int>()] = view;
    }
    return out;
  }

  BestViews views_;
  std::vector<ObjectFrame> frames_;
};

TEST_F(Views, TheLargeWellFittingBoxIsKept) {
  show(0, {decision(1, {100, 100, 200, 200}, 0.5)});
  show(1, {decision(1, {100, 100, 300, 300}, 0.5), decision(2, {400, 100, 450, 200}, 0.9)});
  show(2, {decision(1, {100, 100, 310, 310}, 0.2)});
  show(3, {decision(1, {0, 0, 600, 400}, 0.9, true)});
  const auto views = lines();
  ASSERT_EQ(views.size(), 2U);
  EXPECT_NEAR(views.at(1).at("timestamp").get<double>(), 0.1, 1e-9);
  EXPECT_EQ(views.at(1).at("bbox"), json({100.0, 100.0, 300.0, 300.0}));
  EXPECT_NEAR(views.at(2).at("timestamp").get<double>(), 0.1, 1e-9);
}

TEST_F(Views, ThePictureIsTheBoxWithABorderInsideTheImage) {
  show(0, {decision(1, {440, 200, 640, 300}, 0.5), decision(2, {10, 10, 110, 110}, 0.5)});
  const auto views = lines();
  const cv::Mat right = cv::imdecode(fromBase64(views.at(1).at("jpeg")), cv::IMREAD_COLOR);
  EXPECT_EQ(right.size(), cv::Size(224, 124))
      << "24 px more to the left, none to the right, 12 above and below";
  EXPECT_GT(right.at<cv::Vec3b>(60, 100)[2], 180);
  const cv::Mat left = cv::imdecode(fromBase64(views.at(2).at("jpeg")), cv::IMREAD_COLOR);
  EXPECT_EQ(left.size(), cv::Size(122, 122));
  EXPECT_GT(left.at<cv::Vec3b>(60, 60)[0], 180);
}

TEST_F(Views, LargeOnesAreReduced) {
  show(0, {decision(1, {0, 0, 640, 480}, 0.5)});
  const cv::Mat view = cv::imdecode(fromBase64(lines().at(1).at("jpeg")), cv::IMREAD_COLOR);
  EXPECT_EQ(view.size(), cv::Size(320, 240));
}

// Two landmarks turn out to be one, and a third box to be another object's.
TEST_F(Views, AreThoseOfTheLandmarksInTheEnd) {
  show(0, {decision(1, {100, 100, 200, 200}, 0.5)});
  show(1, {decision(2, {100, 100, 300, 300}, 0.5)});
  show(2, {decision(3, {50, 50, 90, 90}, 0.5)});
  frames_[0].decisions[0].landmark = LandmarkId{7};
  frames_[1].decisions[0].landmark = LandmarkId{7};
  frames_[2].decisions.clear();
  const auto views = lines();
  ASSERT_EQ(views.size(), 1U);
  EXPECT_EQ(views.at(7).at("bbox")[2], 300.0) << "the better of the two";
}

// A sighting that is given up keeps its picture, and follows its landmark.
TEST_F(Views, StayWhenTheirSightingsAreGivenUp) {
  show(0, {decision(1, {100, 100, 300, 300}, 0.5), decision(2, {400, 100, 450, 200}, 0.9)});
  show(1, {decision(1, {100, 100, 200, 200}, 0.5)});
  ObjectFrames frames(frames_);
  frames.giveUp({0}, {{.frame = FrameId{0}, .box = {100, 100, 300, 300}, .landmark = LandmarkId{1}},
                      {.frame = FrameId{0}, .box = {400, 100, 450, 200}, .landmark = LandmarkId{2}}});
  for (auto& sighting : frames.changeFormer())
    if (sighting.landmark == LandmarkId{1}) sighting.landmark = LandmarkId{7};
  const std::string text = views_.text(frames);
  EXPECT_NE(text.find("\"id\":7,"), std::string::npos);
  EXPECT_NE(text.find("\"id\":2,"), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << "that of frame 1 is no better";
}

TEST_F(Views, WithoutPicturesThereAreNone) {
  StepReport report{.kind = StepReport::Kind::kScan};
  views_.onStep(report);
  const Frame dark;
  report.image = &dark;
  report.decisions = {decision(1, {0, 0, 10, 10}, 1)};
  views_.onStep(report);
  EXPECT_EQ(views_.text(frames_), "");
}

}  // namespace
}  // namespace roomgraph::test
