// SPDX-License-Identifier: BSD-3-Clause
// Plans of imports: robot and truth among many frames, registration, clocks, labels.
#include "import_plan.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"

namespace roomgraph::bags {
namespace {

using test::messageOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

/// A bag as the first reading leaves it.
class MadeUpBag {
 public:
  SurveyedTopic& topic(const std::string& name, const std::string& type, const std::string& frame) {
    auto& added = survey_.topics.emplace_back();
    added.topic = {name, type};
    added.type = typeOf(added.topic);
    added.frame = frame;
    added.count = 100;
    added.looked_at = true;
    return added;
  }
  MadeUpBag& odometry(const std::string& name, const std::string& frame, const std::string& child) {
    topic(name, "nav_msgs/Odometry", frame).child_frame = child;
    return *this;
  }
  MadeUpBag& scan(const std::string& name, const std::string& frame, double delay_s = 0, double drift_s = 0) {
    auto& added = topic(name, "sensor_msgs/LaserScan", frame);
    for (int i = 0; i < 100; ++i) added.header_minus_received.add(delay_s + drift_s * i / 100);
    return *this;
  }
  MadeUpBag& camera(const std::string& folder, const std::string& encoding, const std::string& frame,
                    double focal) {
    auto& image = topic(folder + "/image_raw", "sensor_msgs/Image", frame);
    image.image.encoding = encoding;
    image.image.width = 640;
    image.image.height = 480;
    if (focal == 0) return *this;
    auto& info = topic(folder + "/camera_info", "sensor_msgs/CameraInfo", frame).info.emplace();
    info.width = 640;
    info.height = 480;
    info.k = {focal, 0, 320, 0, focal, 240, 0, 0, 1};
    return *this;
  }
  MadeUpBag& link(const std::string& parent, const std::string& child, bool moves) {
    for (int i = 0; i < (moves ? 3 : 1); ++i) {
      TransformMessage transform;
      transform.header.frame = parent;
      transform.child_frame = child;
      transform.parent_from_child = poseFromYpr(0.1 * (i + 1), 0, 0, 0, 0, 0);
      survey_.frames.learn(transform, !moves);
    }
    return *this;
  }
  ImportPlan plan(const BagImportOptions& options = {}) const {
    return planImport(survey_, options, "x.bag");
  }
  Survey& survey() { return survey_; }

 private:
  Survey survey_;
};

TEST(ImportPlan, TheRobotIsItsFootprintElseTheChildOfTheOdometry) {
  MadeUpBag bag;
  bag.odometry("/odom", "odom", "base_link").scan("/scan", "laser").link("odom", "base_link", true);
  EXPECT_EQ(bag.plan().robot, "base_link");
  bag.link("base_footprint", "base_link", false);
  EXPECT_EQ(bag.plan().robot, "base_footprint");
  EXPECT_EQ(bag.plan({.base_frame = "odom"}).robot, "odom");
  MadeUpBag other;
  other.scan("/scan", "laser").link("base_link", "laser", false);
  EXPECT_EQ(other.plan().robot, "base_link");
}

TEST(ImportPlan, WithoutARobotTheCameraIsHandheld) {
  MadeUpBag bag;
  bag.camera("/camera/rgb", "rgb8", "openni_rgb_optical_frame", 525)
      .camera("/camera/depth", "32FC1", "openni_rgb_optical_frame", 525);
  bag.link("world", "kinect", true)
      .link("kinect", "openni_camera", false)
      .link("openni_camera", "openni_rgb_optical_frame", false);
  const auto plan = bag.plan();
  EXPECT_EQ(plan.robot, "");
  EXPECT_EQ(plan.handheld, "openni_rgb_optical_frame");
  EXPECT_EQ(plan.truth.name, "tf world -> openni_rgb_optical_frame");
  EXPECT_THAT(plan.warnings, IsEmpty());
}

TEST(ImportPlan, AWorldInWhichOnlyTheOdometryMovesIsNoTruth) {
  MadeUpBag bag;
  bag.odometry("/odom", "odom", "base_link").link("world", "odom", false).link("odom", "base_link", true);
  EXPECT_EQ(bag.plan().truth.name, "");
  EXPECT_EQ(bag.plan({.truth = "world"}).truth.name, "tf world -> base_link") << "whoever insists";
  MadeUpBag mapped;
  mapped.odometry("/odom", "odom", "base_link").link("map", "odom", true).link("odom", "base_link", true);
  const auto plan = mapped.plan();
  EXPECT_EQ(plan.truth.name, "tf map -> base_link");
  EXPECT_THAT(plan.warnings,
              ElementsAre(HasSubstr("if it is another program's estimate, --truth none leaves it out")));
  EXPECT_EQ(mapped.plan({.truth = "none"}).truth.name, "");
  EXPECT_THAT(messageOf<ConfigError>([&] { mapped.plan({.truth = "moon"}); }),
              HasSubstr("--truth moon: neither a topic nor a frame of tf in which 'base_link' moves; frames: "
                        "base_link, map, odom"));
}

TEST(ImportPlan, TruthOfATopicComesFirst) {
  MadeUpBag bag;
  bag.odometry("/odom", "odom", "base_link").link("mocap", "base_link", true);
  EXPECT_EQ(bag.plan().truth.name, "tf mocap -> base_link");
  bag.topic("/vicon/robot", "geometry_msgs/PoseStamped", "world");
  EXPECT_EQ(bag.plan().truth.name, "/vicon/robot");
  EXPECT_FALSE(bag.plan().truth.track);
}

TEST(ImportPlan, OdometryOfTfStandsInForATopic) {
  MadeUpBag bag;
  bag.scan("/scan", "laser").link("odom", "base_link", true).link("base_link", "laser", false);
  EXPECT_TRUE(bag.plan().odometry);
  EXPECT_FALSE(bag.plan({.topics = {"tf=none"}}).odometry);
  bag.odometry("/odom", "odom", "base_link");
  EXPECT_FALSE(bag.plan().odometry);
}

TEST(ImportPlan, LabelsAreDifferent) {
  MadeUpBag bag;
  bag.scan("/front/scan", "laser_frame")
      .scan("/back/scan", "laser_frame")
      .scan("/third", "")
      .odometry("/odom", "odom", "base");
  EXPECT_THAT(bag.plan().labels, ElementsAre(Pair(0u, "laser"), Pair(1u, "laser_back_scan"),
                                             Pair(2u, "LASER"), Pair(3u, "ODOMETRY")));
}

TEST(ImportPlan, RegistrationIsCheckedByFrameIntrinsicsAndName) {
  const auto planOf = [](const std::string& depth_folder, const std::string& depth_frame, double focal,
                         bool linked) {
    MadeUpBag bag;
    bag.camera("/camera/color", "rgb8", "color", 600).camera(depth_folder, "16UC1", depth_frame, focal);
    if (linked) bag.link("color", "depth", false);
    return bag.plan();
  };
  EXPECT_THAT(planOf("/camera/depth", "color", 600, false).warnings, IsEmpty());
  const auto other = planOf("/camera/depth", "color", 580, false);
  EXPECT_THAT(other.warnings,
              ElementsAre(HasSubstr(
                  "registration: depth has the frame of the colour image but another camera (640x480 "
                  "fx 580.0 fy 580.0 cx 320.0 cy 240.0 against 640x480 fx 600.0")));
  const auto apart = planOf("/camera/depth", "depth", 580, true);
  EXPECT_THAT(apart.warnings, ElementsAre(HasSubstr("registration: depth is not registered to colour")));
  EXPECT_EQ(apart.depth_frame, "depth");
  const auto unknown = planOf("/camera/depth", "depth", 580, false);
  EXPECT_THAT(
      unknown.warnings,
      ElementsAre(HasSubstr("registration: no transform between the frames of depth ('depth') and colour")));
  EXPECT_EQ(unknown.depth_frame, "color");
  const auto named = planOf("/camera/depth_registered", "depth", 600, true);
  EXPECT_THAT(named.warnings,
              ElementsAre(HasSubstr(
                  "is registered to colour by its name, but has frame 'depth' instead of 'color'")));
  EXPECT_EQ(named.depth_frame, "color");
}

TEST(ImportPlan, ACameraInfoMayStandForBoth) {
  MadeUpBag color_only;
  color_only.camera("/a/rgb", "rgb8", "eye", 600).camera("/a/depth", "16UC1", "eye2", 0);
  const auto plan = color_only.plan();
  ASSERT_TRUE(plan.depth);
  EXPECT_EQ(plan.depth->camera.fx, 600);
  EXPECT_THAT(plan.warnings,
              Contains(HasSubstr(
                  "the depth is taken as registered to the colour image, though frame or size differ")));
  MadeUpBag depth_only;
  depth_only.camera("/a/rgb", "rgb8", "other", 0)
      .camera("/a/depth", "16UC1", "eye", 500)
      .scan("/scan", "laser");
  EXPECT_FALSE(depth_only.plan().color) << "another frame";
  EXPECT_TRUE(depth_only.plan().depth);
  EXPECT_THAT(depth_only.plan().warnings,
              Contains(HasSubstr("/a/rgb/image_raw: images are left out: no usable camera_info")));
  EXPECT_EQ(depth_only.plan({.camera = PinholeCamera{0, 0, 700, 700, 320, 240, {}}}).color->camera.width,
            640);
}

TEST(ImportPlan, ClocksAreComparedWithEachOther) {
  MadeUpBag bag;
  bag.scan("/a", "a", -10).scan("/b", "b", -10.05).scan("/c", "c", -7);
  const auto plan = bag.plan();
  EXPECT_THAT(plan.warnings,
              ElementsAre(HasSubstr("/c: clock is 3.00 s ahead of those of the other sensors")))
      << "that all differ from the recorder's alike harms nobody";
  EXPECT_NEAR(plan.window_s, 4, 1e-9);
  EXPECT_THAT(plan.shifts_ns, IsEmpty());
  const auto corrected = bag.plan({.times = BagTimes::kCorrected});
  EXPECT_THAT(corrected.shifts_ns,
              ElementsAre(Pair(0u, 10'000'000'000), Pair(1u, 10'050'000'000), Pair(2u, 7'000'000'000)));
  EXPECT_NEAR(corrected.window_s, 1, 1e-9);
  MadeUpBag drifting;
  drifting.scan("/a", "a", 0, 0.4);
  EXPECT_THAT(drifting.plan().warnings,
              ElementsAre(HasSubstr("/a: clock drifts by 0.30 s against the recorder's")));
}

TEST(ImportPlan, NothingToImportNamesWhatThereIs) {
  MadeUpBag bag;
  EXPECT_THAT(messageOf<InputError>([&] { bag.plan(); }),
              HasSubstr("x.bag: nothing in it can be imported; topics: none"));
  bag.topic("/rosout", "rosgraph_msgs/Log", "");
  EXPECT_THAT(messageOf<InputError>([&] { bag.plan(); }), HasSubstr("topics: /rosout (rosgraph_msgs/Log)"));
  auto& broken = bag.topic("/scan", "sensor_msgs/LaserScan", "");
  broken.looked_at = false;
  broken.broken = broken.count;
  broken.fault = "ends too early";
  EXPECT_THAT(messageOf<InputError>([&] { bag.plan(); }),
              HasSubstr("/scan: no message can be read (ends too early)"));
}

}  // namespace
}  // namespace roomgraph::bags
