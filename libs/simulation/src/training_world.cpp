// SPDX-License-Identifier: BSD-3-Clause
// Variation of surfaces, shapes, cameras and sensor faults for training views.
#include "training_world.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "flat_draft.h"
#include "roomgraph/geometry/degree.h"
#include "roomgraph/geometry/pose.h"
#include "sitting.h"

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

/// Is a disc around a place free of furniture that stands on the floor (taken as discs)?
bool isFree(const World& world, const Eigen::Vector2d& at, double radius_m) {
  return std::ranges::none_of(world.furniture, [&](const Furniture& item) {
    const double reach = item.size_m ? 0.5 * std::min(item.size_m->x(), item.size_m->y()) : 0.3;
    return item.at_m.z() < 0.3 && (item.at_m.head<2>() - at).norm() < reach + radius_m;
  });
}

Eigen::Vector2d drawPlace(const Room& room, double margin_m, Random& random) {
  return {random.uniform(room.min_m.x() + margin_m, room.max_m.x() - margin_m),
          random.uniform(room.min_m.y() + margin_m, room.max_m.y() - margin_m)};
}

Person drawTrainingPerson(Random& random) {
  Person out;
  out.height_m = random.uniform(1.5, 1.95);
  out.skin = pick(random, skinColors());
  out.hair = pick(random, hairColors());
  return out;
}

/// Somebody on one of four seats; knees may be below a desk, as where people work.
void seatMore(World& world, Random& random) {
  for (const Furniture& seat : world.furniture) {
    const auto height = seatHeight(seat);
    if (!height || seat.model == "stool" || !random.chance(0.25)) continue;
    const double along = seat.model == "sofa" ? random.uniform(-0.4, 0.4) : 0;
    const Pose2 at = placeOnSeat(seat, along);
    Person person = drawTrainingPerson(random);
    person.sits = true;
    person.path_m = {{at.x, at.y}};
    person.yaw_rad = at.yaw;
    person.seat_height_m = *height;
    world.people.push_back(person);
  }
}

/// Up to two more people in each room, every second one walking.
void standMore(World& world, Random& random) {
  for (const Room& room : world.rooms) {
    if ((room.max_m - room.min_m).minCoeff() < 1.2) continue;
    for (int more = drawInt(random, 0, 2); more > 0; --more) {
      const Eigen::Vector2d at = drawPlace(room, 0.35, random), to = drawPlace(room, 0.35, random);
      if (!isFree(world, at, 0.3)) continue;
      Person person = drawTrainingPerson(random);
      person.path_m = {at};
      person.yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
      if (random.chance(0.5) && (to - at).norm() > 0.5) person.path_m.push_back(to);
      world.people.push_back(person);
    }
  }
}

/// More chairs where there is room: they are what is looked for most.
void addChairs(World& world, Random& random) {
  static const std::vector<std::string> kinds{"swivel_chair", "swivel_chair", "wooden_chair",
                                              "visitor_chair"};
  for (const Room& room : world.rooms) {
    if ((room.max_m - room.min_m).minCoeff() < 1.5) continue;
    for (int more = drawInt(random, 0, 3); more > 0; --more) {
      const Eigen::Vector2d at = drawPlace(room, 0.5, random);
      if (!isFree(world, at, 0.3)) continue;
      Furniture chair;
      chair.model = pick(random, kinds);
      chair.at_m = {at.x(), at.y(), 0};
      chair.yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
      const bool swivel = chair.model == "swivel_chair";
      const double width = random.uniform(0.42, 0.55) + (swivel ? 0.1 : 0);
      chair.size_m = {width, width * random.uniform(0.9, 1.1),
                      random.uniform(0.78, 1.0) + (swivel ? 0.08 : 0)};
      world.furniture.push_back(chair);
    }
  }
}

}  // namespace

void varyWorld(World& world, const MeshChoice& meshes, Random& random) {
  addChairs(world, random);
  seatMore(world, random);
  standMore(world, random);
  static const std::vector<std::string> walls{"plain", "paint", "plaster", "fabric", "wood", "tiles"},
      floors{"paint", "carpet", "parquet", "tiles", "wood", "leather"};
  for (auto& room : world.rooms) {
    if (random.chance(0.4)) room.wall = drawSurface(walls, random);
    if (random.chance(0.4)) room.floor = drawSurface(floors, random);
    for (auto& doorway : room.doorways) {
      if (random.chance(0.6)) doorway.color = drawColor(random);
      const bool ajar = doorway.door == DoorState::kOpen || doorway.door == DoorState::kHalfOpen;
      if (ajar && random.chance(0.25)) doorway.door = DoorState::kNone;  // a passage looks much like a door
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

namespace {

constexpr double kCloseShare = 0.35;  // of the views

/// From the path: what a robot sees, or who walks where it drives.
Pose3 viewFromPath(const Scene& scene, double seconds, Random& random) {
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
  return poseFromYpr(at.x(), at.y(), at.z(), yaw, pitch,
                     random.chance(0.5) ? 0 : 4 * kDegree * random.normal());
}

/// From close by, over tables and round corners: objects are cut by the picture's edge and by what stands
/// before them, and often the floor is not in view.
Pose3 closeView(const SceneObject& object, Random& random) {
  const Eigen::Vector3d middle =
      object.world_from_object.translation() + 0.6 * object.size_wdh.z() * Eigen::Vector3d::UnitZ();
  const double direction = random.uniform(-std::numbers::pi, std::numbers::pi),
               away = random.uniform(0.8, 2.2);
  const Eigen::Vector3d at(middle.x() + away * std::cos(direction), middle.y() + away * std::sin(direction),
                           random.uniform(0.7, 1.8));
  const double yaw = direction + std::numbers::pi + random.uniform(-0.5, 0.5);
  const double pitch = std::atan2(at.z() - middle.z(), away) + 10 * kDegree * random.normal();
  return poseFromYpr(at.x(), at.y(), at.z(), yaw, std::clamp(pitch, -12 * kDegree, 42 * kDegree),
                     6 * kDegree * random.normal());
}

}  // namespace

Pose3 drawTrainingView(const Scene& scene, double seconds, Random& random) {
  const bool close = random.chance(kCloseShare) && !scene.objects().empty();
  Pose3 out = close ? closeView(pick(random, scene.objects()), random) : viewFromPath(scene, seconds, random);
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

SeenPlace seenPlace(const Pose3& world_from_object, double height_m, const Eigen::Vector3d& camera) {
  const Eigen::Vector3d to_camera =
      camera - (world_from_object.translation() + 0.5 * height_m * Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d front = world_from_object.linear().col(0);
  return {to_camera.norm(),
          wrapAngle(std::atan2(front.y(), front.x()) - std::atan2(to_camera.y(), to_camera.x()))};
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
