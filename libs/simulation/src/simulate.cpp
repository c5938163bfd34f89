// SPDX-License-Identifier: BSD-3-Clause
// Schedule of the simulated sensors, records of the rawlog and truth files.
#include "roomgraph/simulation/simulate.h"

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cmath>

#include "color_renderer.h"
#include "parallel.h"
#include "persistent_detector.h"
#include "roomgraph/core/output_folder.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/mrpt_camera.h"
#include "roomgraph/observations/rawlog_writer.h"
#include "scene.h"
#include "truth_files.h"

namespace roomgraph {
namespace {

constexpr double kStart = 1700000000;  // s; a fixed day, so that the same seed gives the same bytes
constexpr double kNever = std::numeric_limits<double>::infinity();
enum Stream : std::uint64_t {
  kDepthStream = 1,
  kColorStream,
  kLidarStream,
  kOdometryStream,
  kDetectionStream
};

mrpt::Clock::time_point stamp(double seconds) {
  return mrpt::Clock::fromDouble(kStart + seconds);
}

/// Instants of one sensor.
struct Clock {
  double rate_hz = 0, delay_s = 0;
  int count = 0;
  double next(double end) const {
    const double t = rate_hz > 0 ? count / rate_hz + delay_s : kNever;
    return t <= end + 1e-9 ? t : kNever;
  }
};

double nearest(const cv::Mat& depth) {
  double out = 10;  // m; far enough for any precision
  for (const float z : cv::Mat_<float>(depth))
    if (z > 0) out = std::min<double>(out, z);
  return out;
}

class Simulation {
 public:
  Simulation(const World& world, const std::filesystem::path& folder, const SimulateOptions& options);
  SimulateResult run();

 private:
  void frame(double t);
  void scan(double t);
  void odometry(double t);
  void prepareOdometry();
  void writeRobotTruth(double t);
  void finish();
  Random random(Stream stream, int index = 0) const {
    return Random(options_.seed, stream, static_cast<std::uint64_t>(index));
  }

  const World& world_;
  OutputFolder folder_;
  const SimulateOptions& options_;
  Scene scene_;
  std::unique_ptr<ColorRenderer> renderer_;
  std::unique_ptr<LidarCaster> caster_;
  std::unique_ptr<PersistentDetector> detector_;  ///< empty: errors are independent
  std::vector<Pose2> odometry_;
  RawlogWriter rawlog_;
  TruthFile camera_truth_, robot_truth_, odometry_truth_, boxes_, persons_;
  long last_truth_ms_ = -1;
  Clock frames_, scans_, readings_;
  SimulateResult result_;
};

// objects.json is the last to be put into place.
std::vector<std::string> fileNames(const World& world, bool with_world) {
  std::vector<std::string> names{world.name + ".rawlog", "groundtruth.txt", "groundtruth_robot.txt",
                                 "odometry.txt",         "boxes.jsonl",     "persons.txt",
                                 "calibration.json",     "map_truth.pgm",   "map_truth.yaml"};
  if (with_world) names.push_back("world.json");
  names.push_back("objects.json");
  return names;
}

Simulation::Simulation(const World& world, const std::filesystem::path& folder,
                       const SimulateOptions& options)
    : world_(world),
      folder_(folder, fileNames(world, !options.world_text.empty()), {world.file}),
      options_(options),
      scene_(world),
      rawlog_(folder_.pending(world.name + ".rawlog")),
      camera_truth_(folder_.pending("groundtruth.txt")),
      robot_truth_(folder_.pending("groundtruth_robot.txt")),
      odometry_truth_(folder_.pending("odometry.txt")),
      boxes_(folder_.pending("boxes.jsonl")),
      persons_(folder_.pending("persons.txt")) {
  if (world.camera) {
    frames_.rate_hz = world.camera->rate_hz;
    renderer_ = std::make_unique<ColorRenderer>(scene_, world.camera->model);
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(false);
    mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(world.camera->jpeg_quality);
  }
  if (world.detections && world.detections->persistent)
    detector_ = std::make_unique<PersistentDetector>(scene_, world.camera->model, *world.detections, options.seed);
  if (world.lidar) {
    scans_ = {world.lidar->rate_hz, world.lidar->delay_s, 0};
    caster_ = std::make_unique<LidarCaster>(scene_, world.lidar->at_m.z());
  }
  if (world.odometry) prepareOdometry();
  result_.rawlog = folder / (world.name + ".rawlog");
  result_.objects = static_cast<int>(scene_.objects().size());
  camera_truth_.line(
      "# camera optical frame (x right, y down, z forward) in the world\n# timestamp tx ty tz qx qy qz qw");
  robot_truth_.line(
      "# robot base frame (x forward, y left, z up) in the world, at the instants of images and scans\n"
      "# timestamp tx ty tz qx qy qz qw");
  odometry_truth_.line("# wheel odometry (drifting), starts at 0 0 0\n# timestamp x y yaw");
  persons_.line("# timestamp id x y yaw   (world frame, at the image instants)");
}

void Simulation::prepareOdometry() {
  readings_.rate_hz = world_.odometry->rate_hz;
  std::vector<Pose2> truth;
  for (Clock clock = readings_; clock.next(scene_.duration()) < kNever; ++clock.count)
    truth.push_back(planarPart(scene_.worldFromRobot(clock.next(scene_.duration()))));
  odometry_ = measureOdometry(truth, *world_.odometry, random(kOdometryStream));
}

void Simulation::frame(double t) {
  const int index = frames_.count;
  const CameraSpec& spec = *world_.camera;
  const auto parts = scene_.partPoses(t);
  const Pose3 world_from_camera = scene_.worldFromCamera(t);
  const IdImage exact = rasterize(scene_, parts, world_from_camera, spec.model);
  cv::Mat depth, light;
  TaskBeside beside;
  beside.run([&] {
    depth = measureDepth(exact.depth, spec, random(kDepthStream, index));
    light = ambientLight(exact.depth, spec.model) * world_.light;
  });
  const cv::Mat plain = renderer_->render(parts, world_from_camera, nearest(exact.depth));
  beside.wait();
  const cv::Mat color = measureColor(plain, light, spec, random(kColorStream, index));

  mrpt::obs::CObservation3DRangeScan record;
  record.timestamp = stamp(t);
  record.sensorLabel = "KINECT";
  // MRPT's frame of a range camera has x forward; the record's own default turns it into the optical frame.
  Pose3 robot_from_body = scene_.robotFromCamera();
  robot_from_body.linear() *= bodyFromOptical().transpose();
  record.sensorPose = roomgraph::toMrpt(robot_from_body);
  record.hasIntensityImage = record.hasRangeImage = true;
  record.range_is_depth = true;
  record.rangeUnits = 0.001f;
  record.maxRange = static_cast<float>(spec.far_m);
  record.intensityImage = mrpt::img::CImage(color, mrpt::img::DEEP_COPY);
  record.rangeImage_setSize(depth.rows, depth.cols);
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) record.rangeImage(v, u) = depth.at<std::uint16_t>(v, u);
  record.cameraParams = record.cameraParamsIntensity = toMrpt(spec.model);
  rawlog_.write(record);

  if (world_.detections) {
    auto found = detector_ ? detector_->detect(exact, world_from_camera, t, index)
                           : measureDetections(exact.views, scene_, spec.model, *world_.detections,
                                               random(kDetectionStream, index));
    found.timestamp = record.timestamp;
    found.sensorLabel = "DETECTIONS";
    found.image_label = record.sensorLabel;
    rawlog_.write(toComment(found));
    ++result_.detections;
  }
  writePose(camera_truth_, kStart + t, world_from_camera);
  writeRobotTruth(t);
  writeBoxes(boxes_, index, kStart + t, exact.views, scene_);
  for (const auto& [object, pose] : scene_.persons(t))
    persons_.line("%.3f %d %.4f %.4f %.4f", kStart + t, scene_.objects()[static_cast<std::size_t>(object)].id,
                  pose.x, pose.y, pose.yaw);
  ++frames_.count;
}

// Once where an image and a scan are of one instant: a trajectory has no stamp twice.
void Simulation::writeRobotTruth(double t) {
  const long written = std::lround(1000 * t);  // stamps of truth files are in milliseconds
  if (written == last_truth_ms_) return;
  last_truth_ms_ = written;
  writePose(robot_truth_, kStart + t, scene_.worldFromRobot(t));
}

void Simulation::scan(double t) {
  const LidarSpec& spec = *world_.lidar;
  const Pose2 robot = planarPart(scene_.worldFromRobot(t));
  const auto distances = caster_->cast(robot * Pose2{spec.at_m.x(), spec.at_m.y(), 0}, spec.beams, t);
  auto record = measureScan(distances, spec, random(kLidarStream, scans_.count));
  record.timestamp = stamp(t);
  record.sensorLabel = "LIDAR";
  rawlog_.write(record);
  writeRobotTruth(t);
  ++scans_.count;
}

void Simulation::odometry(double t) {
  const Pose2& pose = odometry_[static_cast<std::size_t>(readings_.count)];
  mrpt::obs::CObservationOdometry record;
  record.timestamp = stamp(t);
  record.sensorLabel = "ODOMETRY";
  record.odometry = {pose.x, pose.y, pose.yaw};
  rawlog_.write(record);
  odometry_truth_.line("%.3f %.5f %.5f %.6f", kStart + t, pose.x, pose.y, pose.yaw);
  ++readings_.count;
}

SimulateResult Simulation::run() {
  const double end = scene_.duration();
  while (true) {
    const double reading = readings_.next(end), image = frames_.next(end), scanned = scans_.next(end);
    const double t = std::min({reading, image, scanned});
    result_.interrupted = options_.interrupted && options_.interrupted();
    if (t == kNever || result_.interrupted) break;
    if (t == reading)
      odometry(t);
    else if (t == image)
      frame(t);
    else
      scan(t);
    result_.seconds = t;
    if (options_.progress) options_.progress(t, end);
  }
  finish();
  return result_;
}

void Simulation::finish() {
  rawlog_.finish();
  for (auto* file : {&camera_truth_, &robot_truth_, &odometry_truth_, &boxes_, &persons_}) file->finish();
  writeObjects(folder_.pending("objects.json"), scene_, result_.seconds);
  writeCalibration(folder_.pending("calibration.json"), world_, scene_);
  const double height = world_.lidar ? world_.lidar->at_m.z() : LidarSpec{}.at_m.z();
  writeMapTruth(folder_.pending("map_truth.pgm"), folder_.pending("map_truth.yaml"),
                LidarCaster(scene_, height).furnishedOutlines(result_.seconds));
  if (!options_.world_text.empty()) {
    OutputFile world(folder_.pending("world.json"));
    world << options_.world_text;
    world.finish();
  }
  folder_.publish();
  result_.frames = frames_.count;
  result_.scans = scans_.count;
  result_.odometry = readings_.count;
}

}  // namespace

SimulateResult simulate(const World& world, const std::filesystem::path& folder,
                        const SimulateOptions& options) {
  return Simulation(world, folder, options).run();
}

}  // namespace roomgraph
