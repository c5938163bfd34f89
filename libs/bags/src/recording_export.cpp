// SPDX-License-Identifier: BSD-3-Clause
// Topics and frames of a rawlog's sensors, and the messages of its records.
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cmath>
#include <set>

#include "bag_writer.h"
#include "message_writing.h"
#include "record_making.h"
#include "roomgraph/bags/bag_export.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/import_output.h"
#include "roomgraph/datasets/observation_reader.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;

const std::string kRobot = "base_link", kOdometry = "odom", kWorld = "world";

// Only these may stand in the name of a topic.
std::string topicWord(std::string label) {
  for (char& c : label)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return label;
}

// Beside the rawlog, if it is there.
Trajectory truthOf(const std::filesystem::path& rawlog) {
  const auto file = placesOf(rawlog).ground_truth;
  return std::filesystem::exists(file) ? readTrajectory(file).trajectory : Trajectory();
}

class RecordingExport {
 public:
  RecordingExport(const std::filesystem::path& bag, Trajectory truth) : bag_(bag), truth_(std::move(truth)) {}

  void write(CObservation& observation, const ObservationReader& reader) {
    const std::int64_t t = bags::toNanoseconds(observation.timestamp);
    writeTruth(t);
    if (auto* images = dynamic_cast<CObservation3DRangeScan*>(&observation))
      writeImages(*images, t, reader);
    else if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation))
      writeScan(*scan, t);
    else if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(&observation))
      writeOdometry(*odometry, t);
    else if (const auto* imu = dynamic_cast<const CObservationIMU*>(&observation))
      writeImu(*imu, t);
    else
      ++left_out_[observation.GetRuntimeClass()->className];
  }
  BagExportResult finish() {
    writeTruth(std::numeric_limits<std::int64_t>::max());
    bag_.finish();
    BagExportResult result{bag_.messages(), {}};
    for (const auto& [reason, count] : left_out_)
      result.warnings.push_back(std::to_string(count) + " records left out: " + reason);
    for (const auto& frame : moving_)
      result.warnings.push_back("frame '" + frame + "' moves on the robot: its poses are in /tf");
    return result;
  }
  bool empty() const { return bag_.messages().empty(); }

 private:
  // "" for the first sensor of a kind, which needs none, else its label.
  std::string nameOf(const std::string& kind, const std::string& label) {
    auto& labels = labels_[kind];
    const bool first = labels.empty() || *labels.begin() == label;
    if (labels.empty() || !first) labels.push_back(label);
    return first ? "" : "_" + topicWord(label);
  }
  static std::string frameOf(const std::string& label, const std::string& fallback,
                             const std::string& ending) {
    return (label.empty() ? fallback : label) + ending;
  }

  // Before the first record of a frame its transform; a transform that changes goes to /tf at the record's
  // time.
  void place(const std::string& frame, const Pose3& robot_from_frame, std::int64_t t) {
    const auto known = placed_.find(frame);
    if (known == placed_.end()) {
      placed_.emplace(frame, std::pair(t, robot_from_frame));
      links_.push_back({kRobot, frame, robot_from_frame});
      bag_.write("/tf_static", "tf2_msgs/TFMessage", t, bags::transformsBytes(links_, t), true);
      return;
    }
    auto& [last_t, last] = known->second;
    if (!moving_.contains(frame) && !robot_from_frame.isApprox(last, 1e-9)) {
      moving_.insert(frame);
      bag_.write("/tf", "tf2_msgs/TFMessage", t, bags::transformsBytes({{kRobot, frame, last}}, last_t));
    }
    if (moving_.contains(frame))
      bag_.write("/tf", "tf2_msgs/TFMessage", t,
                 bags::transformsBytes({{kRobot, frame, robot_from_frame}}, t));
    known->second = {t, robot_from_frame};
  }

  void writeTruth(std::int64_t until) {
    for (; truths_ < truth_.size(); ++truths_) {
      const auto& [seconds, pose] = truth_.poses()[truths_];
      const std::int64_t t = std::llround(1e9 * seconds);
      if (t > until) return;
      bag_.write("/ground_truth", "geometry_msgs/PoseStamped", t, bags::poseBytes(pose, t, kWorld));
    }
  }

  void writeImage(const std::string& folder, const cv::Mat& image, const mrpt::img::TCamera& camera,
                  const std::string& frame, std::int64_t t) {
    bag_.write(folder + "/camera_info", "sensor_msgs/CameraInfo", t, bags::cameraInfoBytes(camera, t, frame));
    bag_.write(folder + "/image_raw", "sensor_msgs/Image", t, bags::imageBytes(image, t, frame));
  }

  // Depth as it is recorded, in metres unless its unit is a millimetre.
  static cv::Mat depthOf(CObservation3DRangeScan& images) {
    auto& ranges = images.rangeImage;
    const cv::Mat raw(static_cast<int>(ranges.rows()), static_cast<int>(ranges.cols()), CV_16UC1,
                      ranges.data());
    if (std::abs(images.rangeUnits - 0.001f) < 1e-8f) return raw;
    cv::Mat metres;
    raw.convertTo(metres, CV_32F, images.rangeUnits);
    return metres;
  }

  void writeImages(CObservation3DRangeScan& images, std::int64_t t, const ObservationReader& reader) {
    const std::string folder = "/camera" + nameOf("camera", images.sensorLabel);
    const std::string color_frame = frameOf(images.sensorLabel, "camera", "_optical_frame");
    if (images.hasRangeImage && !images.range_is_depth)
      return writeFrame(images, t, reader, folder, color_frame);
    Pose3 forward_from_optical = Pose3::Identity();
    forward_from_optical.linear() = bodyFromOptical();
    const Pose3 robot_from_depth = toPose3(images.sensorPose) * forward_from_optical;
    const bool apart = images.hasIntensityImage && !images.doDepthAndIntensityCamerasCoincide();
    place(
        color_frame,
        apart ? toPose3(images.sensorPose) * toPose3(images.relativePoseIntensityWRTDepth) : robot_from_depth,
        t);
    const std::string depth_frame =
        apart ? frameOf(images.sensorLabel, "camera", "_depth_optical_frame") : color_frame;
    if (apart) place(depth_frame, robot_from_depth, t);
    if (images.hasIntensityImage)
      writeImage(folder + "/rgb", images.intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY),
                 images.cameraParamsIntensity, color_frame, t);
    if (images.hasRangeImage)
      writeImage(folder + "/depth", depthOf(images), images.cameraParams, depth_frame, t);
  }

  // Ranges along the rays, which ROS does not know: as a run sees them.
  void writeFrame(CObservation3DRangeScan& images, std::int64_t t, const ObservationReader& reader,
                  const std::string& folder, const std::string& frame_name) {
    const auto frame = reader.frameOf(images);
    if (!frame) {
      ++left_out_[frame.reason()];
      return;
    }
    place(frame_name, frame->robot_from_camera, t);
    if (!frame->color.empty()) writeImage(folder + "/rgb", frame->color, toMrpt(frame->camera), frame_name, t);
    writeImage(folder + "/depth", frame->depth, toMrpt(frame->camera), frame_name, t);
  }

  void writeScan(const CObservation2DRangeScan& scan, std::int64_t t) {
    const std::string frame = frameOf(scan.sensorLabel, "laser", "_frame");
    place(frame, toPose3(scan.sensorPose), t);
    bag_.write("/scan" + nameOf("scan", scan.sensorLabel), "sensor_msgs/LaserScan", t,
               bags::scanBytes(scan, t, frame));
  }

  void writeOdometry(const CObservationOdometry& odometry, std::int64_t t) {
    const std::string name = nameOf("odometry", odometry.sensorLabel), frame = kOdometry + name;
    bag_.write("/odom" + name, "nav_msgs/Odometry", t, bags::odometryBytes(odometry, t, frame, kRobot));
    const auto& p = odometry.odometry;
    if (!name.empty()) return;  // the robot has one parent
    bag_.write("/tf", "tf2_msgs/TFMessage", t,
               bags::transformsBytes({{frame, kRobot, toPose3(Pose2{p.x(), p.y(), p.phi()})}}, t));
  }

  void writeImu(const CObservationIMU& imu, std::int64_t t) {
    const std::string frame = frameOf(imu.sensorLabel, "imu", "_frame");
    place(frame, toPose3(imu.sensorPose), t);
    bag_.write("/imu" + nameOf("imu", imu.sensorLabel), "sensor_msgs/Imu", t, bags::imuBytes(imu, t, frame));
  }

  bags::BagWriter bag_;
  Trajectory truth_;
  std::size_t truths_ = 0;                                        ///< poses of it that are written
  std::map<std::string, std::vector<std::string>> labels_;        ///< by kind, in the order of appearance
  std::map<std::string, std::pair<std::int64_t, Pose3>> placed_;  ///< last transform by frame
  std::vector<bags::FrameLink> links_;                            ///< of /tf_static
  std::set<std::string> moving_;
  std::map<std::string, int> left_out_;
};

}  // namespace

BagExportResult exportRecording(const std::filesystem::path& rawlog, const std::filesystem::path& bag,
                                const std::function<void(double)>& progress) {
  ObservationReader reader(rawlog);
  requireOther(bag, {rawlog});
  RecordingExport out(bag, truthOf(rawlog));
  while (const auto observation = reader.next()) {
    out.write(*observation, reader);
    if (progress) progress(reader.progress());
  }
  if (out.empty()) throw InputError(rawlog.string() + ": nothing in it can be exported");
  auto result = out.finish();
  if (!reader.truncation().empty()) result.warnings.push_back(reader.truncation());
  for (const auto& [reason, count] : reader.skipped())
    result.warnings.push_back(std::to_string(count) + " records skipped: " + reason);
  return result;
}

}  // namespace roomgraph
