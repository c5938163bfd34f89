// SPDX-License-Identifier: BSD-3-Clause
// Mesh solids by volume and normals, furniture sizes, person model and walk.
#include "models.h"

#include <gtest/gtest.h>

#include <numbers>

#include "mesh_builder.h"
#include "person_model.h"

namespace roomgraph {
namespace {

/// Signed volume by the divergence theorem: right only when the surface is closed and faces outwards.
double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum +=
        t.position[0].cast<double>().dot(t.position[1].cast<double>().cross(t.position[2].cast<double>())) /
        6;
  return sum;
}

TEST(MeshBuilder, SolidsHaveTheirVolume) {
  MaterialList materials;
  const Eigen::Vector3d center(0.3, -0.2, 0.5);
  const auto made = [&](auto&& build) {
    MeshBuilder builder(materials);
    build(builder.use({"plain", {}, 1, 0}));
    return volume(builder.take());
  };
  EXPECT_NEAR(made([&](MeshBuilder& m) { m.box(center, {1, 2, 3}); }), 6, 1e-5);
  const double pi = std::numbers::pi;
  // Inscribed polyhedra are a little smaller.
  EXPECT_NEAR(made([&](MeshBuilder& m) { m.ellipsoid(center, {1, 2, 3}); }), 8 * pi, 0.08 * 8 * pi);
  EXPECT_NEAR(made([&](MeshBuilder& m) { m.rod(center, center + Eigen::Vector3d(0, 2, 0), 0.5, 0.5); }),
              pi / 2, 0.04 * pi);
  // Box of 2 x 2 x 2 with edges of radius 0.5: core, six plates, twelve quarter rods, one ball.
  const double rounded = 1 + 6 * 0.5 + 12 * pi * 0.25 / 4 + 4 * pi / 3 * 0.125;
  EXPECT_NEAR(made([&](MeshBuilder& m) { m.roundedBox(center, {2, 2, 2}, 0.5); }), rounded, 0.02 * rounded);
  // A radius that does not fit is cut to half the shortest side: two plates of 1 x 2, rods of length 1 and 2, one ball.
  const double cut = 2 * 2 * 0.5 + (4 * 1 + 4 * 2) * pi * 0.25 / 4 + 4 * pi / 3 * 0.125;
  EXPECT_NEAR(made([&](MeshBuilder& m) { m.roundedBox(center, {1, 2, 3}, 9); }), cut, 0.03 * cut);
}

TEST(MeshBuilder, NormalsLookOutwards) {
  MaterialList materials;
  MeshBuilder builder(materials);
  builder.use({"plain", {}, 1, 0}).roundedBox({0, 0, 0}, {1, 2, 0.5}, 0.2);
  builder.capsule({3, 0, 0}, {3, 1, 1}, 0.2, 0.1);
  for (const auto& t : builder.take().triangles) {
    const Eigen::Vector3f face = (t.position[1] - t.position[0]).cross(t.position[2] - t.position[0]);
    for (const auto& normal : t.normal) {
      EXPECT_NEAR(normal.norm(), 1, 1e-5);
      EXPECT_GT(normal.dot(face.normalized()), 0.3);
    }
  }
}

TEST(Models, EveryOneFillsItsBoxExactly) {
  for (const auto& name : furnitureModels()) {
    MaterialList materials;
    const Eigen::Vector3d size(0.9, 0.5, 0.7);
    const auto box = furnitureMesh(name, size, {0.5, 0.5, 0.5}, 3, materials).bounds();
    EXPECT_LT((box.min() - Eigen::Vector3d(-0.25, -0.45, 0)).norm(), 1e-5) << name;
    EXPECT_LT((box.max() - Eigen::Vector3d(0.25, 0.45, 0.7)).norm(), 1e-5) << name;
  }
}

TEST(Models, AChairHasItsBackBehindAndASofaALowFront) {
  MaterialList materials;
  const auto highest = [](const Mesh& mesh, double x_from, double x_to) {
    double top = 0;
    for (const auto& t : mesh.triangles)
      for (const auto& p : t.position)
        if (p.x() > x_from && p.x() < x_to) top = std::max<double>(top, p.z());
    return top;
  };
  const Mesh chair = furnitureMesh("swivel_chair", {0.64, 0.62, 1.07}, {0, 0, 0}, 0, materials);
  EXPECT_GT(highest(chair, -1, -0.2), 1.0);
  EXPECT_LT(highest(chair, 0.1, 1), 0.8);
  const Mesh sofa = furnitureMesh("sofa", {1.9, 0.88, 0.82}, {0, 0, 0}, 0, materials);
  EXPECT_GT(highest(sofa, -1, -0.2), 0.78);
  EXPECT_LT(highest(sofa, 0.2, 1), 0.7);
}

TEST(PersonWalk, GoesAlongItsPathAndTurnsRound) {
  Person person;
  person.path_m = {{0, 0}, {4, 0}};
  person.speed_m_s = 1;
  const PersonWalk walk(person);
  EXPECT_NEAR(walk.at(2).pose.x, 2, 1e-9);
  EXPECT_NEAR(walk.at(2).pose.yaw, 0, 1e-9);
  // 4 s there, 1.5 s of turning, then back: at 7.5 s two metres from the far end.
  EXPECT_NEAR(walk.at(7.5).pose.x, 2, 1e-9);
  EXPECT_NEAR(std::abs(walk.at(7.5).pose.yaw), std::numbers::pi, 1e-9);
  for (double t = 0; t < 12; t += 0.02) {
    const auto a = walk.at(t).pose, b = walk.at(t + 0.02).pose;
    EXPECT_LT(std::hypot(b.x - a.x, b.y - a.y), 0.03) << t;
    EXPECT_LT(std::abs(wrapAngle(b.yaw - a.yaw)), 0.06) << t;
  }
}

TEST(PersonModel, IsAsTallAsToldAndStandsOnTheFloor) {
  Person person;
  person.path_m = {{0, 0}};
  person.height_m = 1.9;
  MaterialList materials;
  const PersonModel model(person, materials);
  const auto poses = model.pose({{0, 0, 0}, 0, false});
  Mesh all;
  for (std::size_t i = 0; i < poses.size(); ++i) all.append(model.parts()[i].moved(poses[i]));
  EXPECT_NEAR(all.bounds().max().z(), 1.9, 0.06);
  EXPECT_NEAR(all.bounds().min().z(), 0, 0.03);
}

}  // namespace
}  // namespace roomgraph
