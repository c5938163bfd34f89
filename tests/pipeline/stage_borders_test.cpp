// SPDX-License-Identifier: BSD-3-Clause
// Borders of the stages: sound values pass, each broken one is named; a run goes on without a broken record.
#include "stage_borders.h"

#include <gmock/gmock.h>

#include <limits>

#include "drive.h"
#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/pipeline/replay.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
const std::string kScansAlone = "[tracking]\nenabled = false\n[detection]\nenabled = false\n";

/// A frame of the drive, changed.
template <typename Change>
std::string problemOfFrame(const Change& change) {
  Frame frame = Drive::frame(1);
  change(frame);
  return problemOfRecord(frame);
}

template <typename Change>
std::string problemOfScan(const Change& change) {
  Scan scan = Drive().scan(1);
  change(scan);
  return problemOfRecord(scan);
}

TEST(StageBorders, SoundRecordsPass) {
  EXPECT_EQ(problemOfFrame([](Frame&) {}), "");
  EXPECT_EQ(problemOfFrame([](Frame& f) { f.color = f.depth = cv::Mat(); }), "") << "depth or colour alone";
  EXPECT_EQ(problemOfScan([](Scan&) {}), "");
  EXPECT_EQ(
      problemOfScan([](Scan& s) { s.valid[3] = 0, s.ranges_m[3] = std::numeric_limits<float>::quiet_NaN(); }),
      "")
      << "what is no return may be anything";
  EXPECT_EQ(problemOfRecord(Drive().odometry(1)), "");
  EXPECT_EQ(problemOfRecord(std::make_shared<CObservationDetections>()), "");
}

TEST(StageBorders, BrokenRecordsAreNamed) {
  EXPECT_EQ(problemOfFrame([](Frame& f) { f.t = kNan; }), "frame: it has no time stamp");
  EXPECT_THAT(problemOfFrame([](Frame& f) { f.robot_from_camera.translation().x() = kInfinite; }),
              HasSubstr("pose is not finite"));
  EXPECT_THAT(problemOfFrame([](Frame& f) { f.robot_from_camera.linear() *= 1.01; }),
              HasSubstr("rotation is none"));
  EXPECT_THAT(problemOfFrame([](Frame& f) { f.robot_from_camera.linear().col(0) *= -1; }),
              HasSubstr("rotation is none"))
      << "a mirror";
  EXPECT_THAT(problemOfFrame([](Frame& f) { f.camera.cx = kNan; }), HasSubstr("no intrinsics"));
  EXPECT_THAT(problemOfFrame([](Frame& f) { f.camera.fx = 0; }), HasSubstr("no intrinsics"));
  EXPECT_THAT(problemOfFrame([](Frame& f) { f.depth = cv::Mat(120, 160, CV_32FC1); }),
              HasSubstr("another size"));
  EXPECT_EQ(problemOfScan([](Scan& s) { s.t = -kInfinite; }), "scan: it has no time stamp");
  EXPECT_THAT(problemOfScan([](Scan& s) { s.valid.pop_back(); }), HasSubstr("as many ranges as flags"));
  EXPECT_THAT(problemOfScan([](Scan& s) { s.angle_step_rad = kNan; }), HasSubstr("angles"));
  EXPECT_THAT(problemOfScan([](Scan& s) { s.ranges_m[5] = -1, s.valid[5] = 1; }), HasSubstr("no distance"));
  EXPECT_THAT(problemOfScan([](Scan& s) { s.robot_from_lidar.translation().z() = 1e9; }),
              HasSubstr("1000 km"));
  EXPECT_EQ(problemOfRecord(OdometryReading{1, {kNan, 0, 0}}), "odometry: pose is not finite");
  EXPECT_EQ(problemOfRecord(std::shared_ptr<CObservationDetections>()), "detections: it has no time stamp");
}

// A matrix of random eigenvectors is a covariance exactly when all its eigenvalues are above zero.
TEST(StageBorders, CovariancesAreToldByTheirEigenvalues) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-6, 3);
  for (int i = 0; i < 300; ++i) {
    const int size = 2 + i % 5;
    const Eigen::MatrixXd any = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
    const Eigen::MatrixXd basis = Eigen::HouseholderQR<Eigen::MatrixXd>(any).householderQ();
    Eigen::VectorXd values =
        Eigen::VectorXd::NullaryExpr(size, [&] { return std::pow(10, exponent(random)); });
    const auto matrix = [&] {
      const Eigen::MatrixXd out = basis * values.asDiagonal() * basis.transpose();
      return Eigen::MatrixXd((out + out.transpose()) / 2);
    };
    EXPECT_EQ(problemOfCovariance(matrix()), "") << values.transpose();
    values[i % size] *= -1;
    EXPECT_EQ(problemOfCovariance(matrix()), "covariance is not positive definite") << values.transpose();
    values[i % size] *= -1;
    Eigen::MatrixXd crooked = matrix();
    crooked(0, size - 1) += 1e-4 * crooked.cwiseAbs().maxCoeff();
    EXPECT_EQ(problemOfCovariance(crooked), "covariance is not symmetric");
    crooked(0, 0) = kNan;
    EXPECT_EQ(problemOfCovariance(crooked), "covariance is not finite");
  }
}

TEST(StageBorders, BoxesMeasurementsAndMovements) {
  Detection box{{10, 20, 30, 40}, "chair", "chair", 0.5, {}, {}};
  EXPECT_EQ(problemOfDetection(box), "");
  box.score = 1.5;
  EXPECT_THAT(problemOfDetection(box), HasSubstr("score"));
  box.score = kNan;
  EXPECT_THAT(problemOfDetection(box), HasSubstr("score"));
  box.score = 1;
  box.box.v_max = kInfinite;
  EXPECT_THAT(problemOfDetection(box), HasSubstr("not finite"));

  ObjectMeasurement measurement;
  measurement.proposal.shape = {ShapeKind::kCuboid, 0.5, 0.5, 0.9};
  EXPECT_EQ(problemOfMeasurement(measurement), "");
  const auto broken = [&](const auto& change) {
    ObjectMeasurement other = measurement;
    change(other);
    return problemOfMeasurement(other);
  };
  EXPECT_THAT(broken([](auto& m) { m.confidence = -0.1; }), HasSubstr("confidence"));
  EXPECT_THAT(broken([](auto& m) { m.proposal.shape.width = kNan; }), HasSubstr("size"));
  EXPECT_THAT(broken([](auto& m) { m.proposal.shape.height = -1; }), HasSubstr("size"));
  EXPECT_THAT(broken([](auto& m) { m.proposal.size_information[1] = -1; }), HasSubstr("size information"));
  EXPECT_THAT(broken([](auto& m) { m.proposal.least_size_information[0] = kNan; }), HasSubstr("size information"));
  EXPECT_THAT(broken([](auto& m) { m.proposal.place_by_size(1, 0) = kNan; }), HasSubstr("place on the size"));
  EXPECT_THAT(broken([](auto& m) { m.proposal.camera_from_object.linear().setZero(); }),
              HasSubstr("rotation"));
  EXPECT_THAT(broken([](auto& m) { m.proposal.covariance(3, 3) = 0; }), HasSubstr("positive definite"));

  RelativePose movement{1, 2};
  EXPECT_EQ(problemOfMovement(movement), "");
  movement.covariance(2, 2) = movement.covariance(3, 3) = movement.covariance(4, 4) = 0;
  EXPECT_THAT(problemOfMovement(movement), HasSubstr("positive definite"));
  movement.planar = true;
  EXPECT_EQ(problemOfMovement(movement), "") << "height and tilts were not measured";
  movement.covariance(5, 5) = -1;
  EXPECT_THAT(problemOfMovement(movement), HasSubstr("positive definite"));
  movement.t_b = kNan;
  EXPECT_THAT(problemOfMovement(movement), HasSubstr("time"));
}

TEST(StageBorders, WhatIsLeftOutIsCounted) {
  Reasons reasons;
  std::vector<Detection> boxes(3);
  for (auto& box : boxes) box.box = {1, 2, 3, 4};
  boxes[1].score = 2;
  EXPECT_THAT(withoutBroken(boxes, reasons), SizeIs(2));
  std::vector<RelativePose> closures(2);
  closures[0].covariance(0, 0) = -1;
  EXPECT_THAT(withoutBroken(closures, reasons), SizeIs(1));
  EXPECT_FALSE(isBroken("selection", "", reasons));
  EXPECT_THAT(reasons, testing::UnorderedElementsAre(
                           Pair("detection, left out: score is not in [0, 1]", 1),
                           Pair("loop closing, left out: covariance is not positive definite", 1)));
}

TEST(StageBorders, WhatNothingCanBeDoneWithoutEndsTheRun) {
  Pose3 pose = poseFromYpr(1, 2, 3, 0.4, 0.5, 0.6);
  const Record scan = Drive().scan(1.5);
  EXPECT_NO_THROW(requirePose(pose, scan));
  pose.translation().y() = kNan;
  EXPECT_THAT(messageOf<RunError>([&] { requirePose(pose, scan); }),
              AllOf(HasSubstr("scan at t = 1.500 s"), HasSubstr("localisation"), HasSubstr("not finite")));
  LandmarkEstimates places{{LandmarkId{4}, {}}, {LandmarkId{7}, {}}};
  EXPECT_EQ(&sound(places), &places);
  places[LandmarkId{7}].yaw = kInfinite;
  EXPECT_THAT(messageOf<RunError>([&] { sound(places); }), HasSubstr("landmark 7: "));
}

// The drive with a broken record after each good one.
class BrokenDrive : public RecordStream {
 public:
  explicit BrokenDrive(bool broken) : broken_(broken) {}
  std::optional<Record> next() override {
    const int step = i_ / 4;
    const double t = 0.1 * step;
    if (step > 20) return std::nullopt;
    switch (i_++ % 4) {
      case 0:
        return drive_.odometry(t);
      case 1:
        return broken_ ? Record(OdometryReading{t + 0.01, {kNan, 0, 0}}) : next();
      case 2:
        return last_ = drive_.scan(t);
      default:
        if (!broken_) return next();
        Scan scan = last_;
        scan.t = step % 2 ? kNan : t + 0.02;
        scan.robot_from_lidar.linear() *= 2;
        return scan;
    }
  }

 private:
  Drive drive_;
  Scan last_;
  bool broken_;
  int i_ = 0;
};

TEST(StageBorders, ARunGoesOnWithoutBrokenRecordsAndCountsThem) {
  std::vector<SlamResult> results;
  for (const bool broken : {false, true}) {
    SemanticSlam slam(setupWith(kScansAlone));
    BrokenDrive drive(broken);
    replay(drive, slam);
    results.push_back(slam.finish());
  }
  const auto &whole = results[0], &broken = results[1];
  ASSERT_THAT(whole.world_from_robot, SizeIs(21));
  ASSERT_EQ(broken.world_from_robot.size(), whole.world_from_robot.size());
  for (std::size_t i = 0; i < whole.world_from_robot.size(); ++i)
    EXPECT_EQ(broken.world_from_robot[i].pose.matrix(), whole.world_from_robot[i].pose.matrix())
        << "the same bits";
  EXPECT_EQ(broken.counts.scans, 21);
  EXPECT_THAT(broken.counts.reasons, Contains(Pair("record left out: odometry: pose is not finite", 21)));
  EXPECT_THAT(broken.counts.reasons, Contains(Pair("record left out: scan: it has no time stamp", 10)));
  EXPECT_THAT(broken.counts.reasons, Contains(Pair("record left out: scan: pose's rotation is none", 11)));
}

}  // namespace
}  // namespace roomgraph::test
