// SPDX-License-Identifier: BSD-3-Clause
// Variation of surfaces, shapes, cameras and sensor faults for training views.
#include "training_world.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "flat_draft.h"
#include "roomgraph/geometry/degree.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {
namespace {

using Color = std::array<double, 3>;

/// Mostly greys and browns, as furniture is; sometimes any colour.
Color drawColor(Random& random) {
  const double value = random.uniform(0.05, 0.95), spread = random.chance(0.3) ? 0.5 : 0.12;
  Color out;
  for (double& channel : out) channel = std::clamp(value + spread * random.normal() * 0.6, 0.02, 0.98);
  return out;
}

Material drawSurface(const std::vector<std::string>& patterns, Random& random) {
  return {pick(random, patterns), drawColor(random), inSteps(random.uniform(0.5, 2.4), 0.1),
          drawInt(random, 0, 99)};
}

/// A mesh file for half of what there are some for; empty for the rest.
std::string drawMesh(const MeshChoice& meshes, const std::string& kind, Random& random) {
  const auto known = meshes.find(kind);
  return known == meshes.end() || known->second.empty() || random.chance(0.5)
             ? ""
             : pick(random, known->second).string();
}

void loseObjects(cv::Mat& depth, const cv::Mat& object, Random& random) {
  constexpr int kObjects = 256;
  std::array<char, kObjects> lost{};
  for (char& one : lost) one = random.chance(0.04) ? 1 : 0;
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      const short id = object.at<short>(v, u);
      if (id >= 0 && id < kObjects && lost[static_cast<std::size_t>(id)]) depth.at<std::uint16_t>(v, u) = 0;
    }
}

void losePatches(cv::Mat& depth, Random& random) {
  for (int i = drawInt(random, 0, 6); i > 0; --i) {
    const cv::Point at(drawInt(random, 0, depth.cols - 1), drawInt(random, 0, depth.rows - 1));
    const cv::Size half(drawInt(random, 3, depth.cols / 10), drawInt(random, 3, depth.rows / 6));
    cv::ellipse(depth, at, half, random.uniform(0, 180), 0, 360, cv::Scalar(0), cv::FILLED);
  }
}

}  // namespace

void varyWorld(World& world, const MeshChoice& meshes, Random& random) {
  static const std::vector<std::string> walls{"plain", "paint", "plaster", "fabric", "wood", "tiles"},
      floors{"paint", "carpet", "parquet", "tiles", "wood", "leather"};
  for (auto& room : world.rooms) {
    if (random.chance(0.4)) room.wall = drawSurface(walls, random);
    if (random.chance(0.4)) room.floor = drawSurface(floors, random);
    for (auto& doorway : room.doorways) {
      if (random.chance(0.6)) doorway.color = drawColor(random);
      if (doorway.door == DoorState::kClosed) doorway.mesh_file = drawMesh(meshes, "door", random);
    }
  }
  for (auto& item : world.furniture) {
    if (random.chance(0.6)) item.color = drawColor(random);
    if (item.shape == 0) item.shape = drawInt(random, 1, 9999);
    item.mesh_file = drawMesh(meshes, item.model, random);
  }
  for (auto& person : world.people) {
    person.shirt = drawColor(random);
    person.trousers = drawColor(random);
    person.mesh_file = drawMesh(meshes, person.sits ? "sitting person" : "person", random);
  }
  world.light = drawSkewed(random, 0.35, 1.15, 0.7);
}

CameraSpec drawTrainingCamera(cv::Size size, Random& random) {
  CameraSpec out;
  // 45 to 70 degrees wide: the Kinect's and RealSense's.
  const double focal = size.width / (2 * std::tan(random.uniform(45, 70) * kDegree / 2));
  out.model = {size.width, size.height, focal, focal, (size.width - 1) / 2.0, (size.height - 1) / 2.0, {}};
  out.noise_gain = random.chance(0.12) ? 0 : random.uniform(0.5, 2.5);
  out.near_m = random.uniform(0.3, 0.7);
  out.far_m = random.uniform(3.5, 9);
  out.disparity_step_px *= size.width / 640.0;
  out.focal_px *= size.width / 640.0;
  return out;
}

Pose3 drawTrainingView(const Scene& scene, double seconds, Random& random) {
  const Pose3 robot = scene.worldFromRobot(seconds);
  const Eigen::Vector3d at(robot.translation().x() + random.uniform(-0.15, 0.15),
                           robot.translation().y() + random.uniform(-0.15, 0.15), random.uniform(0.25, 1.75));
  double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
  if (random.chance(0.5) && !scene.objects().empty()) {
    const auto& object = pick(random, scene.objects());
    const Eigen::Vector3d to = object.world_from_object.translation() - at;
    if (to.head<2>().norm() < 5) yaw = std::atan2(to.y(), to.x()) + random.uniform(-0.4, 0.4);
  }
  const double lean = std::clamp(0.35 * (at.z() - 0.25), 0.0, 0.5);  // what looks from above looks down
  const double pitch = std::clamp(lean + 12 * kDegree * random.normal(), -12 * kDegree, 35 * kDegree);
  Pose3 out =
      poseFromYpr(at.x(), at.y(), at.z(), yaw, pitch, random.chance(0.5) ? 0 : 4 * kDegree * random.normal());
  out.linear() *= bodyFromOptical();
  return out;
}

void spoilDepth(cv::Mat& depth, const cv::Mat& object, Random& random) {
  if (random.chance(0.5)) loseObjects(depth, object, random);
  if (random.chance(0.5)) losePatches(depth, random);
  if (random.chance(0.4)) {
    const double scale = random.uniform(0.97, 1.03);
    const cv::Matx23d shift(1, 0, 2 * random.normal(), 0, 1, random.normal());
    cv::Mat moved;
    cv::warpAffine(depth, moved, shift, depth.size(), cv::INTER_NEAREST);
    moved.convertTo(depth, CV_16U, scale);
  }
}

cv::Mat spoilColor(const cv::Mat& color, Random& random) {
  cv::Mat out = color;
  if (random.chance(0.3)) cv::GaussianBlur(out, out, {}, random.uniform(0.4, 1.5));
  const double gain = random.uniform(0.6, 1.5), offset = random.uniform(-20, 20);
  cv::Mat balanced;
  cv::multiply(out, cv::Scalar(gain * random.uniform(0.85, 1.15), gain, gain * random.uniform(0.85, 1.15)),
               balanced, 1, CV_8U);
  balanced.convertTo(balanced, CV_8U, 1, offset);
  if (random.chance(0.5)) {
    std::vector<uchar> bytes;
    cv::imencode(".jpg", balanced, bytes, {cv::IMWRITE_JPEG_QUALITY, drawInt(random, 30, 92)});
    balanced = cv::imdecode(bytes, cv::IMREAD_COLOR);
  }
  return balanced;
}

}  // namespace roomgraph
