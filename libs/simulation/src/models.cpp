// SPDX-License-Identifier: BSD-3-Clause
// Table of furniture models, fit of meshes to a size, and door geometry.
#include "models.h"

#include <functional>
#include <map>

#include "furniture_builders.h"

namespace roomgraph {
namespace {

struct Entry {
  FurnitureModel model;
  std::function<void(const BuildRequest&)> build;
};

const std::map<std::string, Entry>& entries() {
  static const std::map<std::string, Entry> all{
      {"swivel_chair",
       {{"swivel_chair", "swivel_chair", {0.64, 0.62, 1.07}, {0.13, 0.17, 0.28}}, buildSwivelChair}},
      {"sofa", {{"sofa", "sofa", {1.9, 0.88, 0.82}, {0.45, 0.16, 0.14}}, buildSofa}},
      {"wooden_chair", {{"other", "wooden chair", {0.44, 0.44, 0.92}, {0.6, 0.42, 0.25}}, buildWoodenChair}},
      {"desk", {{"other", "desk", {1.6, 0.8, 0.74}, {0.72, 0.56, 0.38}}, buildDesk}},
      {"shelf", {{"other", "shelf", {0.9, 0.3, 1.9}, {0.62, 0.46, 0.3}}, buildShelf}},
      {"cabinet", {{"other", "cabinet", {0.8, 0.45, 1.1}, {0.66, 0.67, 0.68}}, buildCabinet}},
      {"bed", {{"bed", "bed", {1.6, 2.05, 0.9}, {0.5, 0.36, 0.22}}, buildBed}},
      {"table", {{"table", "table", {1.4, 0.8, 0.74}, {0.62, 0.45, 0.28}}, buildTable}},
      {"cupboard", {{"cabinet", "cupboard", {1.0, 0.45, 1.3}, {0.55, 0.4, 0.25}}, buildCupboard}},
      {"refrigerator", {{"refrigerator", "refrigerator", {0.6, 0.65, 1.75}, {0.88, 0.88, 0.87}}, buildRefrigerator}},
      {"block", {{"other", "block", {1, 1, 1}, {0.86, 0.84, 0.78}}, buildBlock}},
      {"plant", {{"other", "plant", {0.75, 0.75, 1.2}, {0.22, 0.42, 0.16}}, buildPlant}},
      {"monitor", {{"other", "monitor", {0.54, 0.2, 0.42}, {0.06, 0.06, 0.07}}, buildMonitor}},
      {"box", {{"other", "box", {0.45, 0.4, 0.35}, {0.68, 0.52, 0.35}}, buildCardboardBox}},
      {"bin", {{"other", "bin", {0.3, 0.3, 0.36}, {0.25, 0.27, 0.3}}, buildBin}},
      {"whiteboard", {{"other", "whiteboard", {1.6, 0.04, 1.0}, {0.9, 0.9, 0.9}}, buildWhiteboard}},
      {"visitor_chair", {{"other", "visitor chair", {0.56, 0.56, 0.84}, {0.15, 0.16, 0.19}}, buildVisitorChair}},
      {"armchair", {{"other", "armchair", {0.84, 0.84, 0.88}, {0.42, 0.3, 0.2}}, buildSofa}},
      {"stool", {{"other", "stool", {0.4, 0.4, 0.5}, {0.55, 0.38, 0.22}}, buildStool}},
      {"bench", {{"other", "bench", {1.4, 0.4, 0.46}, {0.55, 0.4, 0.26}}, buildBench}},
      {"round_table", {{"table", "round table", {1.1, 1.1, 0.74}, {0.6, 0.44, 0.3}}, buildRoundTable}},
      {"printer", {{"other", "printer", {0.46, 0.42, 0.34}, {0.78, 0.78, 0.77}}, buildPrinter}},
      {"coat_stand", {{"other", "coat stand", {0.55, 0.55, 1.8}, {0.3, 0.2, 0.12}}, buildCoatStand}}};
  return all;
}

}  // namespace

Mesh fittedMesh(Mesh mesh, const Eigen::Vector3d& size_wdh) {
  const Eigen::AlignedBox3d box = mesh.bounds();
  const Eigen::Vector3d target(size_wdh.y(), size_wdh.x(), size_wdh.z());
  const Eigen::Vector3d scale = target.cwiseQuotient(box.sizes());
  const Eigen::Vector3d bottom(box.center().x(), box.center().y(), box.min().z());
  for (auto& triangle : mesh.triangles) {
    for (auto& corner : triangle.position)
      corner = (corner.cast<double>() - bottom).cwiseProduct(scale).cast<float>();
    for (auto& normal : triangle.normal)
      normal = normal.cast<double>().cwiseQuotient(scale).normalized().cast<float>();
  }
  return mesh;
}

const std::vector<std::string>& furnitureModels() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const auto& [name, entry] : entries()) out.push_back(name);
    return out;
  }();
  return names;
}

const FurnitureModel& furnitureModel(const std::string& name) {
  return entries().at(name).model;
}

Mesh furnitureMesh(const std::string& name, const Eigen::Vector3d& size_m, const std::array<double, 3>& color,
                   int variant, MaterialList& materials, int shape) {
  MeshBuilder builder(materials);
  entries().at(name).build({builder, size_m.x(), size_m.y(), size_m.z(), color, variant, shape});
  return fittedMesh(builder.take(), size_m);
}

Mesh doorMesh(const Doorway& doorway, double thickness_m, MaterialList& materials) {
  constexpr double kFrame = 0.06, kProud = 0.015, kLeaf = 0.04;
  MeshBuilder mesh(materials);
  const double w = doorway.width_m, h = doorway.height_m, deep = thickness_m + 2 * kProud,
               x = -thickness_m / 2;
  mesh.use({"wood", toned(doorway.color, 0.75), 1.0, 0});
  for (const double side : {-1.0, 1.0}) mesh.box({x, side * (w - kFrame) / 2, h / 2}, {deep, kFrame, h});
  mesh.box({x, 0, h - kFrame / 2}, {deep, w - 2 * kFrame, kFrame});
  // The leaf hangs on the left post (+y) at the inner face.
  const double leaf = w - 2 * kFrame - 0.006, high = h - kFrame - 0.01;
  const double angle = doorway.door == DoorState::kClosed     ? 0
                       : doorway.door == DoorState::kHalfOpen ? 0.8
                                                              : 1.5;
  Pose3 hinge = Pose3::Identity();
  hinge.translate(Eigen::Vector3d(0, w / 2 - kFrame - 0.003, 0.006));
  hinge.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  mesh.frame(hinge).use({"wood", doorway.color, 1.2, 1});
  mesh.box({-kLeaf / 2, -leaf / 2, high / 2}, {kLeaf, leaf, high});
  // Raised panels and handles on both faces.
  for (const double face : {kProud / 2 - 0.004, -kLeaf - kProud / 2 + 0.004}) {
    mesh.use({"wood", toned(doorway.color, 1.12), 1.2, 2});
    mesh.box({face, -leaf / 2, high * 0.74}, {kProud, leaf * 0.68, high * 0.36});
    mesh.box({face, -leaf / 2, high * 0.27}, {kProud, leaf * 0.68, high * 0.36});
    const double out = face > 0 ? 0.05 : -kLeaf - 0.05;
    mesh.use({"metal", {0.75, 0.74, 0.7}, 0.5, 0});
    mesh.rod({-kLeaf / 2, -leaf + 0.07, 1.02}, {out, -leaf + 0.07, 1.02}, 0.012, 0.012);
    mesh.capsule({out, -leaf + 0.07, 1.02}, {out, -leaf + 0.19, 1.02}, 0.011, 0.011);
  }
  return mesh.take();
}

}  // namespace roomgraph
