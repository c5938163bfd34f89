// SPDX-License-Identifier: BSD-3-Clause
// TUM import: pairing, cameras, mirrored ICL-NUIM poses, and files put into place together.
#include "roomgraph/datasets/tum_import.h"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

#include "errors_of.h"
#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/camera_presets.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/datasets/truth_file.h"
#include "roomgraph/datasets/tum_export.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using roomgraph::test::messageOf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Depth that is projected into the colour image is written in fifths of a millimetre: 16 bits reach to 13.1 m.
TEST(TumExport, WhatIsFartherThanItsDepthReachesIsNotKnown) {
  const TemporaryFolder folder;
  const auto images = makeImages(1);
  images->relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0.001, 0, 0, -M_PI / 2, 0, -M_PI / 2);
  for (int v = 0; v < 12; ++v)
    for (int u = 0; u < 16; ++u) images->rangeImage(v, u) = u < 8 ? 13000 : 20000;
  writeRawlog(folder.file("x.rawlog"), {images});
  ASSERT_EQ(exportTum(folder.file("x.rawlog"), folder.file("tum")).registered, 1);
  const cv::Mat depth = cv::imread((folder.file("tum/depth") / "1.000000000.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(depth.type(), CV_16UC1);
  int near = 0;
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      const int value = depth.at<std::uint16_t>(v, u);
      near += value == 64995;  // a millimetre less than 13 m
      EXPECT_TRUE(value == 0 || value == 64995) << u << ", " << v << ": " << value;
    }
  EXPECT_GT(near, 50);
}

class TumImport : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.file("rgb"));
    std::filesystem::create_directories(folder_.file("depth"));
    writeBytes(folder_.file("camera.json"),
               R"({"width": 8, "height": 6, "fx": 10, "fy": 11, "cx": 3.5, "cy": 2.5,
                                            "distortion": [0, 0, 0, 0, 0], "depth_scale": 5000})");
  }
  /// Image pair `name`, all of whose depth pixels have the given value.
  void addImages(const std::string& name, std::uint16_t depth) {
    cv::imwrite(folder_.file("rgb/" + name + ".png").string(),
                cv::Mat(6, 8, CV_8UC3, cv::Scalar(10, 120, 230)));
    cv::imwrite(folder_.file("depth/" + name + ".png").string(), cv::Mat(6, 8, CV_16UC1, cv::Scalar(depth)));
  }
  TumImportResult convert(const TumImportOptions& options = {}) {
    return importTum(folder_.path(), folder_.file("out.rawlog"), options);
  }
  std::vector<Frame> frames() {
    std::vector<Frame> out;
    RawlogReader reader(folder_.file("out.rawlog"));
    while (auto record = reader.next()) out.push_back(std::get<Frame>(std::move(*record)));
    return out;
  }
  static std::vector<std::string> namesIn(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  TemporaryFolder folder_, elsewhere_;
  const std::filesystem::path other_ = elsewhere_.path();
};

TEST_F(TumImport, AssociationsInEitherColumnOrder) {
  // 10001 / 5000 = 2.0002 m: finer than a millimetre.
  addImages("a", 10001);
  addImages("b", 65535);
  const std::string rows[2] = {
      "# comment\n1.50 rgb/a.png 1.51 depth/a.png\n2.50 rgb/b.png 2.51 depth/b.png\n",
      "1.51 depth/a.png 1.50 rgb/a.png\n2.51 depth/b.png 2.50 rgb/b.png\n"};
  for (const auto& text : rows) {
    writeBytes(folder_.file("associations.txt"), text);
    const auto result = convert();
    EXPECT_EQ(result.written, 2);
    EXPECT_THAT(result.warnings, IsEmpty());
    const auto read = frames();
    ASSERT_EQ(read.size(), 2u);
    EXPECT_NEAR(read[0].t, 1.50, 1e-6) << "time of the colour image";
    EXPECT_NEAR(read[0].depth.at<float>(2, 3), 2.0002, 1e-6);
    EXPECT_NEAR(read[1].depth.at<float>(2, 3), 13.107, 1e-5);
    EXPECT_NEAR(read[0].color.at<cv::Vec3b>(2, 3)[2], 230, 3);
    EXPECT_DOUBLE_EQ(read[0].camera.fy, 11);
    EXPECT_TRUE(read[0].robot_from_camera.linear().isApprox(bodyFromOptical(), 1e-9));
    EXPECT_EQ(read[0].sensor_label, "RGBD");
  }
}

TEST_F(TumImport, ColumnsAreToldApartByTheImagesNotTheirNames) {
  addImages("a", 5000);
  std::filesystem::rename(folder_.file("depth/a.png"), folder_.file("x.png"));
  std::filesystem::rename(folder_.file("rgb/a.png"), folder_.file("depth_of_field.png"));
  writeBytes(folder_.file("associations.txt"), "1 depth_of_field.png 1 x.png\n");
  EXPECT_EQ(convert().written, 1);
}

TEST_F(TumImport, NearestStampsArePairedOneToOne) {
  // Colour .030 takes depth .031 (1 ms), so colour .025 is left with .010 (15 ms); colour .100 has none
  // within 20 ms.
  for (const char* name : {"a", "b", "c"}) addImages(name, 1000);
  addImages("near", 2000);
  addImages("far", 3000);
  writeBytes(folder_.file("rgb.txt"), "0.025 rgb/a.png\n0.030 rgb/b.png\n0.100 rgb/c.png\n");
  writeBytes(folder_.file("depth.txt"), "0.031 depth/near.png\n0.010 depth/far.png\n0.1205 depth/c.png\n");
  const auto result = convert();
  EXPECT_EQ(result.written, 2);
  EXPECT_THAT(result.warnings, Contains(HasSubstr("1 of 3 colour images left out")));
  const auto read = frames();
  ASSERT_EQ(read.size(), 2u);
  EXPECT_NEAR(read[0].depth.at<float>(0, 0), 0.6, 1e-6);
  EXPECT_NEAR(read[1].depth.at<float>(0, 0), 0.4, 1e-6);
  EXPECT_EQ(convert({.max_time_difference_s = 0.021}).written, 3);

  // Alone, colour .025 takes the nearer one, which is not the first.
  writeBytes(folder_.file("rgb.txt"), "0.025 rgb/a.png\n");
  EXPECT_EQ(convert().written, 1);
  EXPECT_NEAR(frames().at(0).depth.at<float>(0, 0), 0.4, 1e-6);
}

TEST_F(TumImport, MissingFilesAreCountedAndNothingLeftIsAnError) {
  addImages("a", 5000);
  writeBytes(
      folder_.file("associations.txt"),
      "1 rgb/a.png 1 depth/a.png\n2 rgb/none.png 2 depth/a.png\n3 rgb/a.png 3 depth/none.png\nodd line\n");
  const auto result = convert();
  EXPECT_EQ(result.written, 1);
  EXPECT_EQ(result.missing, 2);
  EXPECT_THAT(result.warnings, Contains(HasSubstr("rgb/none.png")));
  EXPECT_THAT(result.warnings, Contains(HasSubstr("1 lines left out")));
  writeBytes(folder_.file("associations.txt"), "2 rgb/none.png 2 depth/a.png\n");
  const std::string former = readBytes(folder_.file("out.rawlog"));
  EXPECT_THROW(convert(), InputError);
  EXPECT_EQ(readBytes(folder_.file("out.rawlog")), former) << "what was imported before";
  EXPECT_FALSE(std::filesystem::exists(folder_.file("out.rawlog.unfinished")));
}

TEST_F(TumImport, UnusableFoldersAreRefused) {
  EXPECT_THROW(convert(), InputError) << "no list";
  writeBytes(folder_.file("associations.txt"), "# nothing\n");
  EXPECT_THROW(convert(), InputError) << "empty list";
  addImages("a", 5000);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  EXPECT_THROW(importTum(folder_.path(), "/nonexistent/out.rawlog"), RunError);
  EXPECT_THROW(importTum(folder_.file("none"), folder_.file("out.rawlog")), InputError);
  writeBytes(folder_.file("camera.json"), "{");
  EXPECT_THROW(convert(), InputError) << "broken camera.json";
  writeBytes(folder_.file("camera.json"),
             R"({"width": 9, "height": 6, "fx": 1, "fy": 1, "cx": 1, "cy": 1, "depth_scale": 1000})");
  EXPECT_THROW(convert(), InputError) << "size differs";
  std::filesystem::remove(folder_.file("camera.json"));
  EXPECT_THROW(convert(), ConfigError) << "no intrinsics";
  const auto result = convert({.fx = 10, .fy = 10, .cx = 3, .cy = 2, .depth_scale = 1000});
  EXPECT_EQ(result.camera.width, 8) << "size from the images";
  EXPECT_NEAR(frames().at(0).depth.at<float>(0, 0), 5, 1e-6);
}

TEST_F(TumImport, PublishedCameras) {
  addImages("a", 5000);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  for (const auto& preset : cameraPresets()) {
    EXPECT_THAT(messageOf<InputError>([&] { convert({.preset = preset.name}); }),
                AllOf(HasSubstr("none of the 1 pairs can be used"), HasSubstr("the camera 640x480")))
        << preset.name << " is for images of its size, and stands above camera.json";
    EXPECT_TRUE(preset.camera.sees(preset.camera.cx, preset.camera.cy)) << preset.name;
    EXPECT_GT(preset.depth_scale, 0) << preset.name;
  }
  EXPECT_DOUBLE_EQ(findCameraPreset("freiburg1")->camera.distortion[4], 1.163314);
  EXPECT_LT(findCameraPreset("icl")->camera.fy, 0);
  EXPECT_FALSE(findCameraPreset("freiburg4"));
  EXPECT_THAT(messageOf<ConfigError>([&] { convert({.preset = "freiburg4"}); }), HasSubstr("freiburg3|icl"));
}

TEST_F(TumImport, PresetGivesWhatTheOptionsLeaveOpen) {
  cv::imwrite(folder_.file("rgb/a.png").string(), cv::Mat(480, 640, CV_8UC3, cv::Scalar(10, 120, 230)));
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(2000));
  depth.at<std::uint16_t>(7, 9) = 65535;
  cv::imwrite(folder_.file("depth/a.png").string(), depth);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  const auto result = convert({.preset = "7scenes", .fx = 580});
  EXPECT_DOUBLE_EQ(result.camera.fx, 580);
  EXPECT_DOUBLE_EQ(result.camera.fy, 585);
  const auto frame = frames().at(0);
  EXPECT_NEAR(frame.depth.at<float>(5, 5), 2, 1e-6);
  EXPECT_EQ(frame.depth.at<float>(7, 9), 0) << "7-Scenes marks with 65535 where nothing was measured";
}

TEST_F(TumImport, EverythingThatIsMissingIsNamedAtOnce) {
  const auto folder = folder_.file("rgbd_dataset_freiburg2_desk");
  std::filesystem::create_directories(folder);
  writeBytes(folder / "associations.txt", "1 rgb/a.png 1 depth/a.png\n");
  const auto refusal = [&](const TumImportOptions& options) {
    return messageOf<ConfigError>([&] { importTum(folder, folder_.file("out.rawlog"), options); });
  };
  EXPECT_THAT(refusal({}),
              AllOf(HasSubstr("no fx, fy, cx, cy, depth_scale"), HasSubstr("speaks for --camera freiburg2"),
                    HasSubstr("freiburg1|freiburg2|freiburg3|icl|kinect|7scenes"), HasSubstr("camera.json")));
  EXPECT_THAT(refusal({.fx = 500, .fy = 500}), HasSubstr("no cx, cy, depth_scale ("));
  writeBytes(folder / "camera.json", R"({"fx": 1, "fy": 1, "cx": 1, "cy": 1})");
  EXPECT_THAT(refusal({}), HasSubstr("no depth_scale ("));
}

TEST_F(TumImport, CameraOnARobot) {
  addImages("a", 5000);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  Pose3 pose = parsePose("0.1,0,0.9,0,10,0", "test");
  convert({.robot_from_sensor = pose});
  pose.linear() = pose.linear() * bodyFromOptical();
  EXPECT_TRUE(frames().at(0).robot_from_camera.isApprox(pose, 1e-6));
}

TEST_F(TumImport, PrincipalPointOutsideTheImageIsWarnedAbout) {
  addImages("a", 5000);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  EXPECT_THAT(convert().warnings, IsEmpty());
  EXPECT_THAT(convert({.cx = 9999}).warnings,
              Contains(AllOf(HasSubstr("principal point (9999, 2.5)"), HasSubstr("8x6"))));
}

TEST_F(TumImport, OutputMustBeAFile) {
  addImages("a", 5000);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  const auto refusal = [&](const std::filesystem::path& out) {
    return messageOf<RunError>([&] { importTum(folder_.path(), out); });
  };
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("is a folder; name the rawlog to write"));
  EXPECT_THAT(refusal(folder_.file("none/out.rawlog")), HasSubstr("there is no folder"));
}

TEST_F(TumImport, ExternalImagesStayLossless) {
  addImages("a", 5001);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  for (const char* name : {"out.rawlog", "zipped.rawlog.gz"}) {
    const auto file = other_ / name;
    EXPECT_EQ(importTum(folder_.path(), file, {.external_images = true}).written, 1);
    RawlogReader reader(file);
    const auto frame = std::get<Frame>(reader.next().value());
    EXPECT_EQ(frame.color.at<cv::Vec3b>(2, 3), cv::Vec3b(10, 120, 230));
    EXPECT_NEAR(frame.depth.at<float>(2, 3), 1.0002, 1e-6);
  }
  EXPECT_THAT(namesIn(other_), ElementsAre("out.rawlog", "out_Images", "zipped.rawlog.gz", "zipped_Images"));
}

TEST_F(TumImport, AFormerImportStaysWholeUntilTheNewOneIs) {
  addImages("a", 5000);
  addImages("b", 6000);
  const auto import = [&](const std::function<void(std::size_t, std::size_t)>& progress) {
    return importTum(folder_.path(), other_ / "x.rawlog", {.external_images = true}, progress);
  };
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  writeBytes(folder_.file("groundtruth.txt"), "1 0 0 0 0 0 0 1\n");
  import(nullptr);
  const auto former = namesIn(other_ / "x_Images");
  writeBytes(folder_.file("associations.txt"), "2 rgb/b.png 2 depth/b.png\n");
  writeBytes(folder_.file("groundtruth.txt"), "2 0 0 0 0 0 0 1\n");
  // A folder in its place is what the last step of writing a rawlog fails at.
  const auto place = other_ / "x.rawlog", aside = other_ / "aside";
  EXPECT_THROW(import([&](std::size_t, std::size_t) {
                 std::filesystem::rename(place, aside);
                 std::filesystem::create_directories(place / "occupied");
               }),
               RunError);
  std::filesystem::remove_all(place);
  std::filesystem::rename(aside, place);
  EXPECT_EQ(namesIn(other_ / "x_Images"), former);
  EXPECT_EQ(readBytes(other_ / "x.groundtruth.txt"), truthComment(TruthOf::kCamera) + "1 0 0 0 0 0 0 1\n");
  EXPECT_THAT(namesIn(other_), ElementsAre("x.groundtruth.txt", "x.rawlog", "x_Images"));
  import(nullptr);
  EXPECT_THAT(namesIn(other_ / "x_Images"), ElementsAre("RGBD_2.000000_depth.bin", "RGBD_2.000000_rgb.png"));
  EXPECT_EQ(readBytes(other_ / "x.groundtruth.txt"), truthComment(TruthOf::kCamera) + "2 0 0 0 0 0 0 1\n");
  EXPECT_THAT(namesIn(other_), ElementsAre("x.groundtruth.txt", "x.rawlog", "x_Images"));
  // One that was killed while it moved the images left the former ones in its own folder.
  std::filesystem::create_directories(other_ / "x_Images.unfinished");
  std::filesystem::rename(other_ / "x_Images", other_ / "x_Images.unfinished/old");
  EXPECT_THROW(import([](std::size_t, std::size_t) { throw Interrupted("now"); }), Interrupted);
  EXPECT_EQ(namesIn(other_ / "x_Images").size(), 2u);
  EXPECT_THAT(namesIn(other_), ElementsAre("x.groundtruth.txt", "x.rawlog", "x_Images"));
}

TEST_F(TumImport, NothingOfAFormerImportIsLeftBesideANewOne) {
  addImages("a", 5000);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  writeBytes(folder_.file("groundtruth.txt"), "1 0 0 0 0 0 0 1\n");
  const auto file = other_ / "x.rawlog";
  importTum(folder_.path(), file, {.external_images = true});
  std::filesystem::remove(folder_.file("groundtruth.txt"));
  const auto result = importTum(folder_.path(), file);
  EXPECT_THAT(namesIn(other_), ElementsAre("x.rawlog"));
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("x.groundtruth.txt of the former import was removed"),
                                           HasSubstr("x_Images of the former import was removed")));
  // Of somebody else: not beside an import, and not only images of one.
  std::filesystem::remove(file);
  writeBytes(other_ / "x.groundtruth.txt", "mine");
  EXPECT_THAT(importTum(folder_.path(), file).warnings, IsEmpty());
  importTum(folder_.path(), file, {.external_images = true});
  writeBytes(other_ / "x_Images" / "holiday.png", "mine");
  importTum(folder_.path(), file);
  EXPECT_EQ(readBytes(other_ / "x_Images" / "holiday.png"), "mine");
  EXPECT_THAT(messageOf<ConfigError>([&] { importTum(folder_.path(), file, {.external_images = true}); }),
              HasSubstr("x_Images: is not from an import"));
  EXPECT_EQ(readBytes(other_ / "x_Images" / "holiday.png"), "mine");
}

TEST_F(TumImport, WhatIsReadIsNotReplaced) {
  addImages("a", 5000);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  for (const char* name : {"associations.txt", "camera.json", "rgb/a.png", "depth/a.png"}) {
    const std::string before = readBytes(folder_.file(name));
    EXPECT_THAT(messageOf<ConfigError>([&] { importTum(folder_.path(), folder_.file(name)); }),
                HasSubstr("is read by this import"))
        << name;
    EXPECT_EQ(readBytes(folder_.file(name)), before);
  }
  const auto refusal = [&](const std::filesystem::path& folder, const std::filesystem::path& rawlog) {
    return messageOf<ConfigError>([&] { importTum(folder, rawlog, {.external_images = true}); });
  };
  const auto input = other_ / "desk_Images";
  std::filesystem::copy(folder_.path(), input, std::filesystem::copy_options::recursive);
  std::filesystem::create_directory_symlink(input, other_ / "link");
  for (const auto& folder : {input, other_ / "link", input / ""})
    EXPECT_THAT(refusal(folder, other_ / "desk.rawlog"), HasSubstr("is read; name another rawlog")) << folder;
  EXPECT_THAT(refusal(input, input / "x.rawlog"), HasSubstr("is read")) << "in the folder";
  std::filesystem::create_directories(other_ / "y_Images");
  std::filesystem::rename(input, other_ / "y_Images/desk");
  EXPECT_THAT(refusal(other_ / "y_Images/desk", other_ / "y.rawlog"), HasSubstr("is read")) << "around it";
  writeBytes(folder_.file("associations.txt"),
             "1 " + (other_ / "y_Images/desk/rgb/a.png").string() + " 1 depth/a.png\n");
  EXPECT_THAT(refusal(folder_.path(), other_ / "y.rawlog"), HasSubstr("is read")) << "an image elsewhere";
  EXPECT_TRUE(std::filesystem::exists(other_ / "y_Images/desk/rgb/a.png"));
}

TEST_F(TumImport, NegativeFocalLengthMirrorsTheWorldOnly) {
  addImages("0", 5000);
  addImages("1", 5000);
  writeBytes(folder_.file("associations.txt"), "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n");
  EXPECT_THAT(convert().warnings, Contains(HasSubstr("frame numbers")));
  // A pose of ICL-NUIM's left-handed world, and a point in its camera frame (y up).
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.8, 0.1, -0.5, 0.3).normalized();
  const Eigen::Vector3d position(1, 2, 3), point(0.2, 0.1, 2);
  char line[200];
  std::snprintf(line, sizeof line, "30 1 2 3 %.9f %.9f %.9f %.9f\n", q.x(), q.y(), q.z(), q.w());
  writeBytes(folder_.file("livingRoom0.gt.freiburg"), line);
  const auto result = convert({.fy = -11, .frame_rate_hz = 30});
  EXPECT_TRUE(result.mirrored);
  EXPECT_DOUBLE_EQ(result.camera.fy, 11);
  EXPECT_NEAR(frames().at(1).t, 1 / 30.0, 1e-6);

  std::ifstream truth(result.ground_truth);
  std::string comment;
  std::getline(truth, comment);
  double t;
  Eigen::Vector3d p;
  Eigen::Quaterniond r;
  ASSERT_TRUE(truth >> t >> p.x() >> p.y() >> p.z() >> r.x() >> r.y() >> r.z() >> r.w());
  EXPECT_NEAR(t, 1, 1e-9);
  // The point falls on the same pixel, and its place in the world is the mirror image of what it was.
  const Eigen::Vector3d mirror(1, -1, 1);
  const Eigen::Vector3d point_down = mirror.cwiseProduct(point);
  EXPECT_NEAR(result.camera.project(point_down).y(), -11 * point.y() / point.z() + 2.5, 1e-12);
  const Eigen::Vector3d world_before = q * point + position;
  EXPECT_NEAR((r * point_down + p - mirror.cwiseProduct(world_before)).norm(), 0, 1e-6);
}

TEST_F(TumImport, GroundTruthIsCopiedAsItIs) {
  addImages("a", 5000);
  writeBytes(folder_.file("associations.txt"), "1 rgb/a.png 1 depth/a.png\n");
  const std::string truth = "# timestamp tx ty tz qx qy qz qw\n1.000000 0.1 0.2 0.3 0 0 0 1\n";
  writeBytes(folder_.file("groundtruth.txt"), truth);
  const auto result = convert();
  EXPECT_EQ(result.ground_truth, folder_.file("out.groundtruth.txt"));
  EXPECT_EQ(readBytes(result.ground_truth), truthComment(TruthOf::kCamera) + truth);
}

}  // namespace
}  // namespace roomgraph
