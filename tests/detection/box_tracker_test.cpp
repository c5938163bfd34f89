// SPDX-License-Identifier: BSD-3-Clause
// BoxTracker on synthetic images: shift, scale, occlusion, camera motion, cut boxes.
#include "roomgraph/detection/box_tracker.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

namespace roomgraph {
namespace {

constexpr int kWidth = 640, kHeight = 480;

const ObjectDatabase& chairsAndPeople() {
  static const ObjectDatabase db = ObjectDatabase::fromText(
      "[swivel_chair]\nlabels = chair\n[person]\nlabels = person\nlandmark = false\n");
  return db;
}

cv::Mat texture(unsigned seed, cv::Size size, int cell = 5) {
  std::mt19937 random(seed);
  cv::Mat coarse(size / cell, CV_8UC1), fine;
  for (int i = 0; i < coarse.rows * coarse.cols; ++i)
    coarse.data[i] = static_cast<unsigned char>(random() % 256);
  cv::resize(coarse, fine, size, 0, 0, cv::INTER_NEAREST);
  cv::GaussianBlur(fine, fine, {}, 1.2);
  return fine;
}

/// A textured rectangle that moves and grows in front of a wall, by exact resampling.
class Stage2d {
 public:
  explicit Stage2d(unsigned seed)
      : wall_(texture(seed, {kWidth, kHeight})), patch_(texture(seed + 100, {200, 200})) {}

  /// `wall_shift`: movement of the wall, px, as when the camera turns.
  Frame show(int index, const Box2& box, double depth_m, cv::Point2d wall_shift = {}) const {
    Frame frame;
    frame.id = FrameId{index};
    frame.t = 0.1 * index;
    frame.camera = {kWidth, kHeight, 525, 525, 319.5, 239.5, {}};
    const cv::Matx23d wall_move(1, 0, wall_shift.x, 0, 1, wall_shift.y);
    cv::warpAffine(wall_, frame.gray, wall_move, {kWidth, kHeight}, cv::INTER_LINEAR, cv::BORDER_REFLECT);
    frame.depth = cv::Mat(frame.gray.size(), CV_32FC1, cv::Scalar(4));
    paste(frame, box, depth_m, patch_);
    return frame;
  }
  static void paste(Frame& frame, const Box2& box, double depth_m, const cv::Mat& patch) {
    const cv::Matx23d move(box.width() / patch.cols, 0, box.u_min, 0, box.height() / patch.rows, box.v_min);
    cv::Mat moved, covered;
    cv::warpAffine(patch, moved, move, frame.gray.size(), cv::INTER_LINEAR);
    cv::warpAffine(cv::Mat(patch.size(), CV_8UC1, cv::Scalar(255)), covered, move, frame.gray.size(),
                   cv::INTER_NEAREST);
    moved.copyTo(frame.gray, covered);
    frame.depth.setTo(depth_m, covered);
  }

 private:
  cv::Mat wall_, patch_;
};

Detection detection(const Box2& box, const std::string& name = "swivel_chair", double score = 0.8) {
  return {box, name, name, score, {}, {}};
}

Box2 moved(const Box2& box, double scale, double du, double dv) {
  const Eigen::Vector2d c = box.center() + Eigen::Vector2d(du, dv);
  return {c.x() - scale * box.width() / 2, c.y() - scale * box.height() / 2, c.x() + scale * box.width() / 2,
          c.y() + scale * box.height() / 2};
}

BoxTracker tracker() {
  return BoxTracker(chairsAndPeople());
}

/// The carried boxes; that something is carried at all is expected.
std::vector<Detection> advanced(BoxTracker& boxes, const Frame& frame, const std::optional<Pose3>& movement) {
  const auto carried = boxes.advance(frame, movement);
  EXPECT_TRUE(carried.has_value());
  return carried.value_or(std::vector<Detection>());
}

TEST(BoxTracker, FollowsShiftAndScale) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    for (const char* name : {"swivel_chair", "person"}) {
      const Stage2d stage(seed);
      const Box2 first{250, 150, 370, 330};
      BoxTracker boxes = tracker();
      boxes.start({detection(first, name)}, stage.show(0, first, 2));
      for (int i = 1; i <= 5; ++i) {
        const Box2 truth = moved(first, std::pow(1.04, i), 9.0 * i, -4.0 * i);
        const auto carried = advanced(boxes, stage.show(i, truth, 2 / std::pow(1.04, i), {-3.0 * i, 0}), {});
        ASSERT_EQ(carried.size(), 1u) << name << " seed " << seed << " frame " << i;
        EXPECT_GT(iou(carried[0].box, truth), 0.95) << name << " seed " << seed << " frame " << i;
        EXPECT_TRUE(carried[0].carried);
        EXPECT_EQ(carried[0].class_name, name);
        EXPECT_NEAR(carried[0].score, 0.8 * std::pow(0.97, i), 1e-9);
      }
    }
  }
}

TEST(BoxTracker, WithoutDepthThePictureIsEnough) {
  const Stage2d stage(4);
  const Box2 first{250, 150, 370, 330}, second = moved(first, 1, 12, 5);
  Frame a = stage.show(0, first, 2), b = stage.show(1, second, 2, {-4, 0});
  a.depth.release();
  b.depth.release();
  BoxTracker boxes = tracker();
  boxes.start({detection(first)}, a);
  const auto carried = advanced(boxes, b, {});
  ASSERT_EQ(carried.size(), 1u);
  EXPECT_GT(iou(carried[0].box, second), 0.95);
}

TEST(BoxTracker, TwoBoxesGoTheirOwnWays) {
  const Stage2d stage(5);
  const cv::Mat other = texture(77, {120, 160});
  const auto frame = [&](int i) {
    Frame out = stage.show(i, {100.0 + 8 * i, 200, 220.0 + 8 * i, 320}, 2);
    Stage2d::paste(out, {400.0 - 6 * i, 100, 520.0 - 6 * i, 260}, 1.5, other);
    return out;
  };
  BoxTracker boxes = tracker();
  boxes.start({detection({100, 200, 220, 320}), detection({400, 100, 520, 260}, "person", 0.5)}, frame(0));
  std::vector<Detection> carried;
  for (int i = 1; i <= 4; ++i) carried = advanced(boxes, frame(i), {});
  ASSERT_EQ(carried.size(), 2u);
  EXPECT_GT(iou(carried[0].box, {132, 200, 252, 320}), 0.95);
  EXPECT_GT(iou(carried[1].box, {376, 100, 496, 260}), 0.95);
}

TEST(BoxTracker, EndsBehindAnOccluder) {
  for (const char* name : {"swivel_chair", "person"}) {
    const Stage2d stage(6);
    const cv::Mat occluder = texture(42, {240, 300}, 8);
    const Box2 box{250, 150, 370, 330};
    Frame hidden = stage.show(1, box, 2);
    Stage2d::paste(hidden, {220, 120, 460, 420}, 1, occluder);
    BoxTracker boxes = tracker();
    boxes.start({detection(box, name)}, stage.show(0, box, 2));
    // The camera stands still: the place of the box is known, and something else is there.
    EXPECT_TRUE(advanced(boxes, hidden, Pose3::Identity()).empty()) << name;
    EXPECT_TRUE(advanced(boxes, stage.show(2, box, 2), Pose3::Identity()).empty()) << "it came back";
  }
}

TEST(BoxTracker, EndsWhenItLeavesTheImage) {
  const Stage2d stage(7);
  BoxTracker boxes = tracker();
  const auto at = [](int i) { return Box2{450.0 + 12 * i, 150, 570.0 + 12 * i, 330}; };
  boxes.start({detection(at(0))}, stage.show(0, at(0), 2));
  int last = 0;
  for (int i = 1; i < 20; ++i) {
    const auto carried = advanced(boxes, stage.show(i, at(i), 2), {});
    if (carried.empty()) break;
    EXPECT_LE(carried[0].box.u_max, kWidth);
    EXPECT_GT(iou(carried[0].box, clipped(at(i), kWidth, kHeight)), 0.85) << i;
    last = i;
  }
  EXPECT_GE(last, 8);  // still more than half inside
  EXPECT_LE(last, 14);
}

// A chair of one colour has no corners: it stands, so the camera's movement tells where its box is.
TEST(BoxTracker, StandingObjectsWithoutTextureFollowTheCamera) {
  const Stage2d stage(8);
  const cv::Mat plain(200, 200, CV_8UC1, cv::Scalar(90));
  const Eigen::Vector3d center(0.2, 0.1, 2), half(0.3, 0.4, 0);
  const PinholeCamera camera{kWidth, kHeight, 525, 525, 319.5, 239.5, {}};
  const auto boxFrom = [&](const Pose3& camera_from_world) {
    const Eigen::Vector2d a = camera.project(camera_from_world * Eigen::Vector3d(center - half));
    const Eigen::Vector2d b = camera.project(camera_from_world * Eigen::Vector3d(center + half));
    return Box2{a.x(), a.y(), b.x(), b.y()};
  };
  const auto frame = [&](int i, const Pose3& camera_from_world) {
    Frame out = stage.show(i, {0, 0, 1, 1}, 4);
    out.gray.setTo(90);
    Stage2d::paste(out, boxFrom(camera_from_world), (camera_from_world * center).z(), plain);
    return out;
  };
  Pose3 step = Pose3::Identity();  // previous_from_current: forward, sideways
  step.translation() = Eigen::Vector3d(0.03, 0, 0.06);
  for (const char* name : {"swivel_chair", "person"}) {
    BoxTracker boxes = tracker();
    Pose3 world_from_camera = Pose3::Identity();
    boxes.start({detection(boxFrom(world_from_camera), name)}, frame(0, world_from_camera));
    for (int i = 1; i <= 5; ++i) {
      world_from_camera = world_from_camera * step;
      const Pose3 camera_from_world = world_from_camera.inverse();
      const auto carried = advanced(boxes, frame(i, camera_from_world), step);
      if (std::string(name) == "person") {
        EXPECT_TRUE(carried.empty()) << "people do not stand still";
        continue;
      }
      ASSERT_EQ(carried.size(), 1u) << i;
      EXPECT_GT(iou(carried[0].box, boxFrom(camera_from_world)), 0.97) << i;
    }
    boxes.start({detection(boxFrom(Pose3::Identity()), name)}, frame(0, Pose3::Identity()));
    EXPECT_TRUE(advanced(boxes, frame(1, step.inverse()), {}).empty()) << "movement unknown";
  }
}

TEST(BoxTracker, SidesCutByTheBorderStayCut) {
  const Stage2d stage(9);
  const auto full = [](int i) { return Box2{-60.0 + 6 * i, 100, 140.0 + 6 * i, 300}; };
  BoxTracker boxes = tracker();
  boxes.start({detection(clipped(full(0), kWidth, kHeight))}, stage.show(0, full(0), 2));
  std::vector<Detection> carried;
  for (int i = 1; i <= 4; ++i) carried = advanced(boxes, stage.show(i, full(i), 2), {});
  ASSERT_EQ(carried.size(), 1u);
  EXPECT_GT(iou(carried[0].box, clipped(full(4), kWidth, kHeight)), 0.95);
  EXPECT_EQ(carried[0].box.u_min, 0);
}

TEST(BoxTracker, NothingIsCarriedWithoutImagesOfOneSize) {
  const Stage2d stage(10);
  const Box2 box{250, 150, 370, 330};
  BoxTracker boxes = tracker();
  EXPECT_FALSE(boxes.advance(stage.show(0, box, 2), {})) << "nothing was started";
  boxes.start({}, stage.show(1, box, 2));
  EXPECT_TRUE(advanced(boxes, stage.show(2, box, 2), {}).empty()) << "that there is nothing is carried, too";
  Frame small = stage.show(3, box, 2);
  cv::resize(small.gray, small.gray, {}, 0.5, 0.5);
  for (const cv::Mat& image : {cv::Mat(), small.gray}) {
    boxes.start({detection(box)}, stage.show(4, box, 2));
    EXPECT_EQ(advanced(boxes, stage.show(5, box, 2), {}).size(), 1u);
    Frame other = stage.show(6, box, 2);
    other.gray = image;
    EXPECT_FALSE(boxes.advance(other, {}));
    EXPECT_FALSE(boxes.advance(stage.show(7, box, 2), {})) << "not before the detector ran again";
    boxes.start({detection(box)}, other);
    EXPECT_EQ(boxes.advance(stage.show(8, box, 2), {}).has_value(), false) << "started without this size";
  }
}

TEST(BoxTracker, MaskKeepsTheSizeOfTheBox) {
  const Stage2d stage(11);
  const Box2 first{250, 150, 370, 330}, second = moved(first, 1.1, 5, 0);
  Detection masked = detection(first);
  masked.mask = cv::Mat(180, 120, CV_8UC1, cv::Scalar(255));
  BoxTracker boxes = tracker();
  boxes.start({masked}, stage.show(0, first, 2));
  const auto carried = advanced(boxes, stage.show(1, second, 2), {});
  ASSERT_EQ(carried.size(), 1u);
  EXPECT_EQ(carried[0].mask.cols, std::lround(carried[0].box.width()));
  EXPECT_EQ(carried[0].mask.rows, std::lround(carried[0].box.height()));
  EXPECT_EQ(masked.mask.size(), cv::Size(120, 180)) << "the detection that was given stays";
}

TEST(BoxTracker, MasksAreCutWithTheirBoxes) {
  const Stage2d stage(12);
  const Box2 first{12, 150, 132, 330};
  Detection masked = detection(first);
  masked.mask = cv::Mat(180, 120, CV_8UC1, cv::Scalar(255));
  masked.mask.colRange(0, 60) = 0;  // the left half is not the object
  BoxTracker boxes = tracker();
  boxes.start({masked}, stage.show(0, first, 2));
  for (int k = 1; k <= 5; ++k) {
    const auto carried = advanced(boxes, stage.show(k, moved(first, 1, -6.0 * k, 0), 2), {});
    ASSERT_EQ(carried.size(), 1u);
    const cv::Mat& mask = carried[0].mask;
    EXPECT_NEAR(mask.cols - cv::countNonZero(mask.row(90)), 60 - std::max(0, 6 * k - 12), 2) << k;
    EXPECT_NEAR(cv::countNonZero(mask.row(90)), 60, 2) << k << ": the right half is in the image";
  }
}

}  // namespace
}  // namespace roomgraph
