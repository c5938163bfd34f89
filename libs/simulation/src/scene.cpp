// SPDX-License-Identifier: BSD-3-Clause
// Scene built from a world: building, furniture, doors, people and path.
#include "scene.h"

#include <filesystem>

#include "floor_plan.h"
#include "mesh_file.h"
#include "models.h"
#include "roomgraph/geometry/convex_polygon.h"

namespace roomgraph {
namespace {

std::vector<Eigen::Vector2d> lowHull(const Mesh& world_mesh) {
  constexpr double kLow_m = 1.0;
  std::vector<Eigen::Vector2d> points;
  for (const auto& triangle : world_mesh.triangles)
    for (const auto& corner : triangle.position)
      if (corner.z() < kLow_m) points.emplace_back(corner.cast<double>().head<2>());
  if (points.empty())
    for (const auto& triangle : world_mesh.triangles)
      for (const auto& corner : triangle.position) points.emplace_back(corner.cast<double>().head<2>());
  return convexHull<double>(points);
}

std::string modelName(const std::string& built, const std::string& mesh_file) {
  return mesh_file.empty() ? "procedural:" + built
                           : "mesh:" + std::filesystem::path(mesh_file).stem().string();
}

Mesh doorShape(const Doorway& doorway, double thickness, MaterialList& materials) {
  if (doorway.mesh_file.empty()) return doorMesh(doorway, thickness, materials);
  constexpr double kProud = 0.02;
  const Mesh mesh = fittedMesh(readMeshFile(doorway.mesh_file, materials),
                               {doorway.width_m, thickness + 2 * kProud, doorway.height_m});
  return mesh.moved(poseFromYpr(-thickness / 2, 0, 0, 0, 0, 0));
}

Pose3 standing(const Eigen::Vector3d& at, double yaw) { return poseFromYpr(at.x(), at.y(), at.z(), yaw, 0, 0); }

}  // namespace

Scene::Scene(const World& world) {
  setPath(world);
  addPart(buildingMesh(world, materials_).moved(world_from_plan_), -1, -1);
  addFurniture(world);
  addDoors(world);
  addPeople(world);
}

void Scene::setPath(const World& world) {
  path_.push_back(world.robot ? SensorPath(*world.robot) : SensorPath(*world.handheld));
  duration_s_ = world.duration_s.value_or(path_[0].duration());
  const Pose3 first = path_[0].at(0);
  world_from_plan_ = toPose3(planarPart(first)).inverse();
  if (world.robot && world.camera) {
    const auto& at = world.camera->at_m;
    robot_from_camera_ = poseFromYpr(at.x(), at.y(), at.z(), 0, world.camera->pitch_down_rad, 0);
    robot_from_camera_.linear() *= bodyFromOptical();
  }
  if (world.handheld) robot_from_camera_ = Pose3(Eigen::Isometry3d(bodyFromOptical()));  // the camera is its own robot
}

Pose3 Scene::worldFromRobot(double seconds) const {
  return world_from_plan_ * path_[0].at(seconds);
}

void Scene::addPart(Mesh mesh, int object, int person) {
  ScenePart part;
  const auto box = mesh.bounds();
  part.center = box.center();
  part.radius = box.sizes().norm() / 2;
  part.mesh = std::move(mesh);
  part.object = object;
  part.person = person;
  part.fixed = person < 0 && (object < 0 || objects_[static_cast<std::size_t>(object)].moves.empty());
  parts_.push_back(std::move(part));
}

void Scene::add(SceneObject object, const Mesh& mesh_in_plan) {
  const Mesh mesh = mesh_in_plan.moved(world_from_plan_);
  object.id = static_cast<int>(objects_.size()) + 1;
  object.world_from_object = world_from_plan_ * object.world_from_object;
  for (auto& [since_s, pose] : object.moves) pose = world_from_plan_ * pose;
  if (object.footprint.empty()) object.footprint = lowHull(mesh);
  objects_.push_back(std::move(object));
  addPart(mesh, static_cast<int>(objects_.size()) - 1, -1);
}

void Scene::addFurniture(const World& world) {
  int variant = 0;
  for (const auto& item : world.furniture) {
    const auto& model = furnitureModel(item.model);
    SceneObject object;
    object.class_name = model.class_name;
    object.kind = model.kind;
    object.model = modelName(item.model, item.mesh_file);
    object.size_wdh = item.size_m.value_or(model.size_m);
    object.world_from_object = standing(item.at_m, item.yaw_rad);
    for (const auto& move : item.moves) object.moves.emplace_back(move.at_s, standing(move.at_m, move.yaw_rad));
    const Mesh mesh = item.mesh_file.empty()
                          ? furnitureMesh(item.model, object.size_wdh, item.color.value_or(model.color),
                                          variant, materials_, item.shape)
                          : fittedMesh(readMeshFile(item.mesh_file, materials_), object.size_wdh);
    ++variant;
    const Pose3 pose = object.world_from_object;
    add(std::move(object), mesh.moved(pose));
  }
}

void Scene::addDoors(const World& world) {
  for (const auto& room : world.rooms) {
    for (const auto& doorway : room.doorways) {
      if (doorway.door == DoorState::kNone) continue;
      const Pose3 frame = wallFrame(room, doorway.side, doorway.at_m);
      const double deep = world.wall_thickness_m;
      SceneObject object;
      object.class_name = object.kind = "door";
      object.model = modelName("door", doorway.mesh_file);
      object.size_wdh = {doorway.width_m, deep, doorway.height_m};
      object.world_from_object = frame * Eigen::Translation3d(-deep / 2, 0, 0);
      // The truth is the door in its wall; an open leaf does not move it.
      for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}})
        object.footprint.emplace_back((world_from_plan_ * object.world_from_object *
                                       Eigen::Vector3d(x * deep / 2, y * doorway.width_m / 2, 0))
                                          .head<2>());
      add(std::move(object), doorShape(doorway, deep, materials_).moved(frame));
    }
  }
}

void Scene::addPeople(const World& world) {
  for (const auto& spec : world.people) {
    Person person = spec;
    for (auto& point : person.path_m)
      point = (world_from_plan_ * Eigen::Vector3d(point.x(), point.y(), 0)).head<2>();
    person.yaw_rad += planarPart(world_from_plan_).yaw;
    people_.emplace_back(person, materials_);
    walks_.emplace_back(person);
    const PersonState first = walks_.back().at(0);
    Mesh standing;
    const auto poses = people_.back().pose(first);
    for (std::size_t i = 0; i < poses.size(); ++i) standing.append(people_.back().parts()[i].moved(poses[i]));
    const auto box = standing.bounds();
    SceneObject object;
    object.id = static_cast<int>(objects_.size()) + 1;
    object.class_name = object.kind = "person";
    object.model = modelName(spec.sits ? "sitting person" : "person", spec.mesh_file);
    object.size_wdh = {box.sizes().y(), box.sizes().x(), box.sizes().z()};
    object.world_from_object = toPose3(first.pose);
    object.moving = !spec.sits && spec.path_m.size() > 1;
    object.footprint = lowHull(standing.moved(object.world_from_object));
    objects_.push_back(object);
    person_objects_.push_back(static_cast<int>(objects_.size()) - 1);
    for (const auto& part : people_.back().parts())
      addPart(part, person_objects_.back(), static_cast<int>(people_.size()) - 1);
  }
}

std::vector<Pose3> Scene::partPoses(double seconds) const {
  std::vector<Pose3> out;
  out.reserve(parts_.size());
  for (std::size_t i = 0; i < parts_.size();) {
    if (parts_[i].person < 0) {
      const int object = parts_[i].object;
      out.push_back(parts_[i].fixed ? Pose3::Identity()
                                    : worldFromObject(object, seconds) *
                                          objects_[static_cast<std::size_t>(object)].world_from_object.inverse());
      ++i;
      continue;
    }
    const auto person = static_cast<std::size_t>(parts_[i].person);
    const PersonState state = walks_[person].at(seconds);
    for (const auto& pose : people_[person].pose(state)) out.push_back(toPose3(state.pose) * pose);
    i = out.size();
  }
  return out;
}

const Pose3& Scene::worldFromObject(int object, double seconds) const {
  const SceneObject& all = objects_[static_cast<std::size_t>(object)];
  const Pose3* out = &all.world_from_object;
  for (const auto& [since_s, pose] : all.moves)
    if (since_s <= seconds) out = &pose;
  return *out;
}

std::vector<std::pair<int, Pose2>> Scene::persons(double seconds) const {
  std::vector<std::pair<int, Pose2>> out;
  for (std::size_t i = 0; i < walks_.size(); ++i)
    out.emplace_back(person_objects_[i], walks_[i].at(seconds).pose);
  return out;
}

}  // namespace roomgraph
