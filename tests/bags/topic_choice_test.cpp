// SPDX-License-Identifier: BSD-3-Clause
// Topics of well-known drivers: which are taken for colour, depth, camera_info, odometry.
#include "topic_choice.h"

#include <gmock/gmock.h>

#include "camera_model.h"
#include "image_decoding.h"

namespace roomgraph::bags {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class Topics {
 public:
  Topics& image(const std::string& name, const std::string& encoding, const std::string& frame = "eye",
                std::uint64_t count = 100) {
    const bool compressed = name.find("/compressed") != std::string::npos;
    auto& topic = add(name, compressed ? "sensor_msgs/CompressedImage" : "sensor_msgs/Image", frame, count);
    topic.image.encoding = encoding;
    topic.image.width = compressed ? 0 : 640;
    topic.image.height = compressed ? 0 : 480;
    return *this;
  }
  Topics& info(const std::string& name, const std::string& frame = "eye") {
    add(name, "sensor_msgs/CameraInfo", frame, 100).info.emplace();
    survey_.topics.back().info->width = 640;
    survey_.topics.back().info->height = 480;
    return *this;
  }
  Topics& other(const std::string& name, const std::string& type, std::uint64_t count = 100) {
    add(name, type, "x", count);
    return *this;
  }
  std::string nameOf(std::optional<std::size_t> topic) const {
    return topic ? survey_.topics[*topic].topic.name : "none";
  }
  TopicChoice choose(const std::vector<std::string>& asked = {}) const {
    return chooseTopics(survey_, asked);
  }
  const Survey& survey() const { return survey_; }

 private:
  SurveyedTopic& add(const std::string& name, const std::string& type, const std::string& frame,
                     std::uint64_t count) {
    auto& topic = survey_.topics.emplace_back();
    topic.topic = {name, type};
    topic.type = typeOf(topic.topic);
    topic.frame = frame;
    topic.count = count;
    topic.looked_at = true;
    return topic;
  }
  Survey survey_;
};

TEST(TopicChoice, RealSense) {
  Topics topics;
  topics.image("/camera/infra1/image_rect_raw", "mono8")
      .image("/camera/color/image_raw", "rgb8")
      .image("/camera/depth/image_rect_raw", "16UC1")
      .image("/camera/aligned_depth_to_color/image_raw", "16UC1")
      .image("/camera/color/image_raw/compressed", "rgb8; jpeg compressed bgr8")
      .info("/camera/depth/camera_info")
      .info("/camera/color/camera_info")
      .info("/camera/aligned_depth_to_color/camera_info");
  const auto choice = topics.choose();
  EXPECT_EQ(topics.nameOf(choice.color), "/camera/color/image_raw");
  EXPECT_EQ(topics.nameOf(choice.depth), "/camera/aligned_depth_to_color/image_raw");
  EXPECT_EQ(topics.nameOf(choice.color_info), "/camera/color/camera_info");
  EXPECT_EQ(topics.nameOf(choice.depth_info), "/camera/aligned_depth_to_color/camera_info");
  EXPECT_THAT(choice.warnings, IsEmpty());
  EXPECT_TRUE(namedRectified("/camera/depth/image_rect_raw"));
  EXPECT_FALSE(namedRectified("/rectory/rgb/image_raw"));
}

TEST(TopicChoice, OpenniCompressed) {
  Topics topics;
  topics.image("/camera/rgb/image_color/compressed", "bgr8; jpeg compressed bgr8")
      .image("/camera/depth/image/compressedDepth", "32FC1; compressedDepth")
      .image("/camera/depth/image_color/compressed", "jpeg")
      .info("/camera/rgb/camera_info")
      .info("/camera/depth/camera_info");
  const auto choice = topics.choose();
  EXPECT_EQ(topics.nameOf(choice.color), "/camera/rgb/image_color/compressed");
  EXPECT_EQ(topics.nameOf(choice.depth), "/camera/depth/image/compressedDepth");
  EXPECT_EQ(topics.nameOf(choice.color_info), "/camera/rgb/camera_info");
  EXPECT_EQ(topics.nameOf(choice.depth_info), "/camera/depth/camera_info");
}

TEST(TopicChoice, TwoCamerasAreNotMixed) {
  Topics topics;
  topics.image("/front/depth/image_raw", "16UC1", "front", 100)
      .image("/back/rgb/image_raw", "rgb8", "back", 200)
      .image("/back/depth/image_raw", "16UC1", "back", 90)
      .image("/front/rgb/image_raw", "rgb8", "front", 100);
  const auto choice = topics.choose();
  EXPECT_EQ(topics.nameOf(choice.color), "/back/rgb/image_raw") << "that with more images";
  EXPECT_EQ(topics.nameOf(choice.depth), "/back/depth/image_raw");
  const auto front = topics.choose({"color=/front/rgb/image_raw", "/front/depth/image_raw"});
  EXPECT_EQ(topics.nameOf(front.color), "/front/rgb/image_raw");
  EXPECT_EQ(topics.nameOf(front.depth), "/front/depth/image_raw");
}

TEST(TopicChoice, CameraInfoElsewhereIsFoundByFrameAndSize) {
  Topics topics;
  topics.image("/image", "bgr8", "eye").info("/calibration/left", "eye").info("/calibration/right", "other");
  const auto choice = topics.choose();
  EXPECT_EQ(topics.nameOf(choice.color_info), "/calibration/left");
  EXPECT_THAT(
      choice.warnings,
      ElementsAre(HasSubstr("/image: no camera_info beside it; /calibration/left has its frame and size")));
  topics.info("/calibration/again", "eye");
  EXPECT_EQ(topics.nameOf(topics.choose().color_info), "none") << "which of two cannot be told";
  EXPECT_EQ(topics.nameOf(topics.choose({"color_info=/calibration/again"}).color_info), "/calibration/again");
}

TEST(TopicChoice, OdometryOfTheWheelsBeforeThatOfOthers) {
  Topics topics;
  topics.other("/ground_truth/odom", "nav_msgs/Odometry", 900)
      .other("/odometry/filtered", "nav_msgs/Odometry", 500)
      .other("/robot/odom", "nav_msgs/Odometry", 100)
      .other("/scan_front", "sensor_msgs/LaserScan")
      .other("/scan_back", "sensor_msgs/LaserScan")
      .other("/tf", "tf/tfMessage");
  const auto choice = topics.choose();
  EXPECT_EQ(topics.nameOf(choice.odometry), "/robot/odom");
  EXPECT_THAT(choice.scans, SizeIs(2));
  EXPECT_EQ(kindOf(choice, topics.survey(), 5), "tf");
  EXPECT_EQ(kindOf(choice, topics.survey(), 0), "");
  const auto one = topics.choose({"scan=/scan_back", "tf=none", "odometry=none"});
  EXPECT_THAT(one.scans, ElementsAre(4u));
  EXPECT_EQ(kindOf(one, topics.survey(), 5), "");
  EXPECT_EQ(topics.nameOf(one.odometry), "none");
}

TEST(TopicChoice, LabelsOfFrames) {
  EXPECT_EQ(labelOfFrame("camera_rgb_optical_frame"), "camera_rgb");
  EXPECT_EQ(labelOfFrame("eye_optical"), "eye");
  EXPECT_EQ(labelOfFrame("laser_link"), "laser");
  EXPECT_EQ(labelOfFrame("rear_link_frame"), "rear_link") << "one ending, so that an export comes back";
  EXPECT_EQ(labelOfFrame("_frame"), "_frame");
  EXPECT_EQ(labelOfFrame(""), "");
}

CameraInfoMessage calibration() {
  CameraInfoMessage info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.distortion = {0.1, 0.2, 0.001, 0.002, 0.3};
  info.k = {500, 0, 320, 0, 510, 240, 0, 0, 1};
  info.p = {480, 0, 318, 0, 0, 485, 238, 0, 0, 0, 1, 0};
  return info;
}

TEST(CameraModel, RawRectifiedAndBinned) {
  const auto raw = cameraModel(calibration(), false);
  EXPECT_EQ(raw.camera, (PinholeCamera{640, 480, 500, 510, 320, 240, {0.1, 0.2, 0.001, 0.002, 0.3}}));
  EXPECT_TRUE(raw.map_x.empty());
  const auto rectified = cameraModel(calibration(), true);
  EXPECT_EQ(rectified.camera, (PinholeCamera{640, 480, 480, 485, 318, 238, {}}));
  auto binned = calibration();
  binned.distortion.clear();
  binned.binning_x = binned.binning_y = 2;
  EXPECT_EQ(cameraModel(binned, false).camera, (PinholeCamera{320, 240, 250, 255, 160, 120, {}}));
}

TEST(CameraModel, FisheyePixelsMoveAsItsFormulaSays) {
  auto info = calibration();
  info.distortion_model = "equidistant";
  info.distortion = {0.05, 0, 0, 0};
  const auto model = cameraModel(info, false);
  ASSERT_FALSE(model.map_x.empty());
  // theta_d = theta (1 + k1 theta^2) for a ray at x = 0.4, y = 0.
  const double theta = std::atan(0.4), distorted = theta * (1 + 0.05 * theta * theta);
  EXPECT_NEAR(model.map_x.at<float>(240, 520), 320 + 500 * distorted, 1e-3);
  EXPECT_NEAR(model.map_y.at<float>(240, 520), 240, 1e-3);
  cv::Mat image = cv::Mat::zeros(480, 640, CV_16UC1);
  image.at<std::uint16_t>(240, static_cast<int>(std::lround(320 + 500 * distorted))) = 1234;
  EXPECT_EQ(model.rectified(image, true).at<std::uint16_t>(240, 520), 1234);
}

TEST(CameraModel, WhatIsNoCalibrationIsRefused) {
  const auto refused = [](auto&& change) {
    auto info = calibration();
    change(info);
    EXPECT_THROW(cameraModel(info, false), BadMessage);
  };
  refused([](auto& info) { info.k = {}; });
  refused([](auto& info) { info.k[0] = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& info) { info.width = 0; });
  refused([](auto& info) { info.width = 1u << 30; });
  refused([](auto& info) { info.distortion[1] = std::numeric_limits<double>::infinity(); });
  refused([](auto& info) { info.distortion.resize(7, 1); });
  refused([](auto& info) { info.distortion_model = "equidistant"; });
}

ImageMessage rawImage(const std::string& encoding, std::uint32_t width, std::uint32_t height,
                      std::uint32_t step, const std::vector<std::uint8_t>& bytes) {
  ImageMessage image;
  image.encoding = encoding;
  image.width = width;
  image.height = height;
  image.step = step;
  image.data = bytes;
  return image;
}

TEST(ImageDecoding, BayerAndYuvOfOneColour) {
  // An orange field: r 200, g 100, b 40.
  const auto mosaic = [](const char* pattern) {
    std::vector<std::uint8_t> bytes;
    for (int v = 0; v < 8; ++v)
      for (int u = 0; u < 8; ++u) {
        const char c = pattern[2 * (v % 2) + u % 2];
        bytes.push_back(c == 'r' ? 200 : c == 'g' ? 100 : 40);
      }
    return bytes;
  };
  for (const char* pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    const auto bytes = mosaic(pattern);
    const auto image = colorImageOf(rawImage(std::string("bayer_") + pattern + "8", 8, 8, 8, bytes), false);
    EXPECT_EQ(image.at<cv::Vec3b>(4, 4), cv::Vec3b(40, 100, 200)) << pattern;
  }
  const std::vector<std::uint8_t> uyvy{128, 90, 128, 90}, yuyv{90, 128, 90, 128};
  const auto grey = colorImageOf(rawImage("yuv422", 2, 1, 4, uyvy), false).at<cv::Vec3b>(0, 1);
  EXPECT_EQ(grey, colorImageOf(rawImage("yuv422_yuy2", 2, 1, 4, yuyv), false).at<cv::Vec3b>(0, 1));
  EXPECT_EQ(grey[0], grey[2]) << "no colour";
}

TEST(ImageDecoding, SizesThatTheBytesDoNotBearAreRefused) {
  const std::vector<std::uint8_t> bytes(24);
  EXPECT_NO_THROW(colorImageOf(rawImage("rgb8", 4, 2, 12, bytes), false));
  EXPECT_NO_THROW(colorImageOf(rawImage("mono8", 4, 2, 20, bytes), false)) << "the last row needs no padding";
  EXPECT_THROW(colorImageOf(rawImage("rgb8", 4, 3, 12, bytes), false), BadMessage);
  EXPECT_THROW(colorImageOf(rawImage("rgb8", 9, 2, 12, bytes), false), BadMessage);
  EXPECT_THROW(colorImageOf(rawImage("rgb8", 0, 2, 12, bytes), false), BadMessage);
  EXPECT_THROW(colorImageOf(rawImage("mono8", 4, 0xffffffffu, 0xffffffffu, bytes), false), BadMessage);
  EXPECT_THROW(colorImageOf(rawImage("yuv422", 3, 1, 6, bytes), false), BadMessage) << "an odd width";
  EXPECT_THROW(depthImageOf(rawImage("8UC1", 4, 2, 4, bytes), false), BadMessage);
}

TEST(ImageDecoding, PicturesThatClaimToBeHugeAreRefused) {
  // A PNG header of 30000 x 30000 px with 16 bit, and nothing behind it.
  const std::vector<std::uint8_t> png{0x89, 'P',  'N', 'G', '\r', '\n', 0x1a, '\n', 0,    0, 0,
                                      13,   'I',  'H', 'D', 'R',  0,    0,    0x75, 0x30, 0, 0,
                                      0x75, 0x30, 16,  0,   0,    0,    0,    0,    0,    0, 0};
  EXPECT_THROW(depthImageOf(rawImage("16UC1; png compressed", 0, 0, 0, png), true), BadMessage);
  const std::vector<std::uint8_t> rvl{0,    0,    0,    0,    0,    0,    0,    0,    0, 0, 0, 0,
                                      0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0x7f, 1, 2, 3, 4};
  EXPECT_THROW(depthImageOf(rawImage("16UC1; compressedDepth rvl", 0, 0, 0, rvl), true), BadMessage);
  EXPECT_THROW(colorImageOf(rawImage("jpeg", 0, 0, 0, {}), true), BadMessage);
}

}  // namespace
}  // namespace roomgraph::bags
