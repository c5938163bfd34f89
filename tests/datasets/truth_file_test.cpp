// SPDX-License-Identifier: BSD-3-Clause
// Whose poses a truth file holds, and exports in which they are the camera's; stamps and images that do not fit.
#include "roomgraph/datasets/truth_file.h"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

#include "errors_of.h"
#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/tum_export.h"
#include "roomgraph/datasets/tum_import.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kTwoPoses = "1.000000001 1 2 0 0 0 0.70710678 0.70710678\n2 1 3 0 0 0 0 1\n";

// A camera 0.5 m ahead and 1 m up that looks ahead.
mrpt::obs::CObservation3DRangeScan::Ptr imagesOnRobot(double t, double ahead_m = 0.5) {
  auto images = makeImages(t);
  images->sensorPose = mrpt::poses::CPose3D(ahead_m, 0, 1, 0, 0, 0);
  return images;
}

TEST(TruthFile, SaysWhosePosesTheyAre) {
  const TemporaryFolder folder;
  EXPECT_EQ(whoseTruth(folder.file("none")), std::nullopt);
  writeBytes(folder.file("t"), kTwoPoses);
  EXPECT_EQ(whoseTruth(folder.file("t")), std::nullopt);
  for (const TruthOf whose : {TruthOf::kRobot, TruthOf::kCamera}) {
    writeBytes(folder.file("t"), "# another comment\n" + truthComment(whose) + kTwoPoses);
    EXPECT_EQ(whoseTruth(folder.file("t")), whose);
  }
}

TEST(TruthFile, PosesOfWhatStandsOnTheRobot) {
  const TemporaryFolder folder;
  writeBytes(folder.file("t"), truthComment(TruthOf::kRobot) + kTwoPoses);
  Pose3 part = Pose3::Identity();
  part.translation() << 0.5, 0, 1;
  // Turned left, ahead is y; the stamp keeps its nanosecond.
  EXPECT_THAT(truthOnRobot(folder.file("t"), part), AllOf(HasSubstr("1.000000001 1 2.5 1 0 0 0.707106781 0.707106781\n"),
                                                          HasSubstr("2 1.5 3 1 0 0 0 1\n")));
}

TEST(TumExport, GroundTruthIsThatOfTheCamera) {
  const TemporaryFolder folder;
  writeRawlog(folder.file("x.rawlog"), {imagesOnRobot(1), imagesOnRobot(2)});
  writeBytes(folder.file("x.groundtruth.txt"), kTwoPoses);
  ASSERT_TRUE(exportTum(folder.file("x.rawlog"), folder.file("tum")).ground_truth);
  const std::string truth = readBytes(folder.file("tum/groundtruth.txt"));
  EXPECT_EQ(whoseTruth(folder.file("tum/groundtruth.txt")), TruthOf::kCamera);
  EXPECT_THAT(truth, HasSubstr("2 1.5 3 1 0.5 -0.5 0.5 -0.5\n")) << "looks along x, right is -y";
  // What says that it is the camera's stays as it is.
  writeBytes(folder.file("x.groundtruth.txt"), truthComment(TruthOf::kCamera) + kTwoPoses);
  exportTum(folder.file("x.rawlog"), folder.file("again"));
  EXPECT_EQ(readBytes(folder.file("again/groundtruth.txt")), truthComment(TruthOf::kCamera) + kTwoPoses);
}

TEST(TumExport, GroundTruthOfARobotOnWhichTheCameraMovesIsLeftOut) {
  const TemporaryFolder folder;
  writeRawlog(folder.file("x.rawlog"), {imagesOnRobot(1), imagesOnRobot(2, 0.6)});
  writeBytes(folder.file("x.groundtruth.txt"), truthComment(TruthOf::kRobot) + kTwoPoses);
  const auto result = exportTum(folder.file("x.rawlog"), folder.file("tum"));
  EXPECT_FALSE(result.ground_truth);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("on which this camera moves")));
}

class TumFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    writeRawlog(folder_.file("x.rawlog"), {makeImages(1), makeImages(2), makeImages(3)});
    exportTum(folder_.file("x.rawlog"), folder_.file("tum"));
  }
  TumImportResult import() { return importTum(folder_.file("tum"), folder_.file("y.rawlog")); }

  const TemporaryFolder folder_;
};

TEST_F(TumFolder, AnImageOfAnotherSizeCostsItsPair) {
  const auto odd = folder_.file("tum/depth") / "2.000000000.png";
  cv::imwrite(odd.string(), cv::Mat(6, 8, CV_16UC1, cv::Scalar(1000)));
  const auto result = import();
  EXPECT_EQ(result.written, 2);
  EXPECT_THAT(result.warnings, Contains(AllOf(HasSubstr("pair left out: "), HasSubstr("2.000000000.png is 8x6 px, the camera 16x12"))));
}

TEST_F(TumFolder, StampsInOtherUnitsAreNoTimes) {
  for (const auto& [stamp, unit] : {std::pair("1700000000200000048", "nanoseconds"), std::pair("1700000000200000", "microseconds")}) {
    const std::string line = std::string(stamp) + " rgb/1.000000000.png " + stamp + " depth/1.000000000.png\n";
    writeBytes(folder_.file("tum/associations.txt"), line);
    EXPECT_THAT(messageOf<InputError>([&] { import(); }), HasSubstr(std::string("its time stamps are in ") + unit));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.file("y.rawlog")));
}

}  // namespace
}  // namespace roomgraph::test
