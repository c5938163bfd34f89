// SPDX-License-Identifier: BSD-3-Clause
// Debug pictures by colour at expected pixels; wireframes, grid and horizon.
#include "roomgraph/rendering/debug_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "random_poses.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/rendering/palette.h"
#include "temporary_folder.h"
#include "wireframe.h"

namespace roomgraph {
namespace {

using test::Random;

const PinholeCamera kCamera{640, 480, 525, 525, 319.5, 239.5, {}};

const ObjectDatabase& redChairsBlueSofas() {
  static const ObjectDatabase db = ObjectDatabase::fromText(
      "[swivel_chair]\nlabels=chair\ncolor=#ff0000\n[sofa]\nlabels=couch\ncolor=#0000ff\n");
  return db;
}

/// A grey picture with two boxes, a mask sample, an edge and a chosen cylinder, and the reports about it.
struct Scenery {
  Frame frame;
  FrameProposals seen;
  StepReport report;

  Scenery() {
    frame.id = FrameId{123};
    frame.t = 12.5;
    frame.camera = kCamera;
    frame.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar(128, 128, 128));
    seen.detections = {{{100, 100, 200, 300}, "swivel_chair", "chair", 0.8, {}, {}},
                       {{400, 120, 600, 360}, "sofa", "couch", 0.6, {}, {}, true}};
    report.kind = StepReport::Kind::kFrame;
    report.frame = frame.id;
    report.t = frame.t;
    report.detections.fresh = true;
    report.detections.boxes = seen.detections;
    report.image = &frame;
  }
  cv::Mat draw() const {
    StepReport with_proposals = report;
    with_proposals.proposals = seen;
    return debugPicture(with_proposals, redChairsBlueSofas());
  }
};

bool like(const cv::Vec3b& bgr, const palette::TColor& color, int tolerance = 40) {
  return std::abs(bgr[0] - color.B) < tolerance && std::abs(bgr[1] - color.G) < tolerance &&
         std::abs(bgr[2] - color.R) < tolerance;
}

int countLike(const cv::Mat& image, const cv::Rect& region, const palette::TColor& color) {
  int count = 0;
  for (int v = region.y; v < region.br().y; ++v)
    for (int u = region.x; u < region.br().x; ++u) count += like(image.at<cv::Vec3b>(v, u), color);
  return count;
}

/// Rows of a region that hold the colour.
int rowsLike(const cv::Mat& image, const cv::Rect& region, const palette::TColor& color) {
  int rows = 0;
  for (int v = region.y; v < region.br().y; ++v)
    rows += countLike(image, {region.x, v, region.width, 1}, color) > 0;
  return rows;
}

const palette::TColor kRed{255, 0, 0}, kBlue{0, 0, 255};

TEST(DebugPicture, BoxesAreWhereTheyShouldBe) {
  Scenery s;
  const cv::Mat image = s.draw();
  ASSERT_EQ(image.size(), s.frame.color.size());
  EXPECT_EQ(rowsLike(image, {98, 130, 5, 150}, kRed), 150) << "left side of the chair's box";
  EXPECT_EQ(rowsLike(image, {196, 130, 6, 150}, kRed), 150) << "right side";
  EXPECT_EQ(countLike(image, {110, 130, 80, 150}, kRed), 0) << "nothing inside";
  const int dashed = rowsLike(image, {398, 150, 5, 200}, kBlue);
  EXPECT_GT(dashed, 90) << "carried: dashed";
  EXPECT_LT(dashed, 170);
  EXPECT_EQ(countLike(image, {398, 150, 5, 200}, kRed), 0);
}

TEST(DebugPicture, TracesAreDrawn) {
  Scenery s;
  s.seen.traces.resize(2);
  for (int i = 0; i < 50; ++i) s.seen.traces[0].mask_pixels.emplace_back(150, 180 + i);
  s.seen.traces[1].segments.push_back({{450, 200}, {550, 200}});
  const cv::Mat image = s.draw();
  EXPECT_EQ(countLike(image, {150, 180, 1, 50}, kRed), 50);
  EXPECT_GT(countLike(image, {450, 199, 100, 3}, {255, 235, 60}), 80);
}

TEST(DebugPicture, ChosenAndRejectedShapesAreDrawn) {
  Scenery s;
  const ObjectShape cylinder{ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  Proposal proposal{.class_name = "swivel_chair", .shape = cylinder};
  proposal.camera_from_object.linear() = bodyFromOptical().transpose();
  proposal.camera_from_object.translation() = Eigen::Vector3d(0.1, 0.8, 2.5);
  const auto projected = projectShape(cylinder, proposal.camera_from_object, kCamera);
  ASSERT_TRUE(projected);
  proposal.projected = *projected;
  const Box2& box = projected->full;
  const cv::Rect around(static_cast<int>(box.u_min), static_cast<int>(box.v_min),
                        static_cast<int>(box.width()), static_cast<int>(box.height()));
  EXPECT_EQ(countLike(s.draw(), around, kRed), 0);
  s.report.decisions.push_back({.landmark = LandmarkId{7}});
  s.report.decisions[0].seen.measurement.proposal = proposal;
  EXPECT_GT(countLike(s.draw(), around, kRed), 300);
  s.report.decisions.clear();
  s.seen.traces.resize(2);
  s.seen.traces[0].rejected.push_back(proposal);
  EXPECT_GT(countLike(s.draw(), around, {170, 170, 170}), 100);
}

TEST(DebugPicture, SaysWhatWentWrong) {
  Scenery s;
  s.report.note = "not tracked: too few inliers";
  const cv::Mat bad = s.draw();
  const cv::Rect bottom(0, 440, 400, 20);
  EXPECT_GT(countLike(bad, bottom, {255, 110, 90}), 100);
  s.report.note.clear();
  s.seen.ground = GroundEstimate{};
  s.seen.ground->plane = {Eigen::Vector3d(0, -1, 0), 0.8};
  EXPECT_EQ(countLike(s.draw(), bottom, {255, 110, 90}), 0);
  EXPECT_TRUE(debugPicture(StepReport{}, redChairsBlueSofas()).empty()) << "not a frame";
  s.frame.color.release();
  EXPECT_TRUE(s.draw().empty());
  s.frame.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(2));
  EXPECT_FALSE(s.draw().empty());
}

TEST(DebugPicture, OneFilePerFrame) {
  Scenery s;
  const test::TemporaryFolder folder;
  DebugPictures pictures(folder.file("pictures"), redChairsBlueSofas());
  pictures.onStep(s.report);
  pictures.onStep(StepReport{});
  EXPECT_EQ(cv::imread(folder.file("pictures/frame_000123.jpg").string()).size(), cv::Size(640, 480));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("pictures")), {}), 1);
  std::filesystem::remove_all(folder.file("pictures"));
  EXPECT_THROW(pictures.onStep(s.report), RunError);
  folder.write("file", "");
  EXPECT_THROW(DebugPictures(folder.file("file/below"), redChairsBlueSofas()), RunError);
}

// The bounds of the drawn edges are those of the projected shape, which is computed in another way.
TEST(Wireframe, HasTheBoundsOfTheProjectedShape) {
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    const ObjectShape shape{static_cast<ShapeKind>(i % 3), 0.6, i % 3 == 0 ? 0.6 : 0.4,
                            random.uniform(0.5, 2)};
    Pose3 pose = Pose3::Identity();
    pose.linear() = bodyFromOptical().transpose() * toPose3(Pose2{0, 0, random.uniform(-3, 3)}).linear();
    pose.translation() =
        Eigen::Vector3d(random.uniform(-1, 1), random.uniform(0.5, 1), random.uniform(2.5, 5));
    const auto projected = projectShape(shape, pose, kCamera);
    ASSERT_TRUE(projected);
    Eigen::AlignedBox2d bounds;
    for (const auto& edge : wireframe(shape, pose, kCamera)) bounds.extend(edge.a).extend(edge.b);
    const double tolerance = shape.kind == ShapeKind::kCylinder ? 2.5 : 1.5;  // a circle has 24 corners here
    EXPECT_NEAR(bounds.min().x(), projected->full.u_min, tolerance) << i;
    EXPECT_NEAR(bounds.min().y(), projected->full.v_min, tolerance) << i;
    EXPECT_NEAR(bounds.max().x(), projected->full.u_max, tolerance) << i;
    EXPECT_NEAR(bounds.max().y(), projected->full.v_max, tolerance) << i;
  }
}

TEST(Wireframe, LinesBehindTheCameraAreCut) {
  EXPECT_FALSE(projectSegment({0, 0, -1}, {1, 0, -2}, kCamera));
  const auto cut = projectSegment({0, 1, -1}, {0, 1, 3}, kCamera, 0.5);
  ASSERT_TRUE(cut);
  EXPECT_NEAR(cut->a.y(), 239.5 + 525 * 1 / 0.5, 1e-9);
  EXPECT_NEAR(cut->b.y(), 239.5 + 525 * 1 / 3.0, 1e-9);
}

// Far points of the ground come ever closer to the horizon.
TEST(Wireframe, HorizonIsWhereTheGroundVanishes) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    Pose3 world_from_camera = poseFromYpr(1, 2, 0.9, random.uniform(-3, 3), 0.2, random.uniform(-0.2, 0.2));
    world_from_camera.linear() = world_from_camera.linear() * bodyFromOptical();
    const Plane ground = groundInCamera(world_from_camera);
    const auto line = horizon(ground, kCamera);
    ASSERT_TRUE(line);
    const Eigen::Vector3d ahead = cameraFromGround(ground) * Eigen::Vector3d(1e6, 1e5, 0);
    const Eigen::Vector2d far = kCamera.project(ahead);
    const double ratio = (far.x() - line->a.x()) / (line->b.x() - line->a.x());
    EXPECT_NEAR(far.y(), line->a.y() + ratio * (line->b.y() - line->a.y()), 0.01);
  }
}

}  // namespace
}  // namespace roomgraph
