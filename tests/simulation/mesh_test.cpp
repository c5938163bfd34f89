// SPDX-License-Identifier: BSD-3-Clause
// Material list, rigid motion of meshes, closed solids.
#include "roomgraph/simulation/mesh.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "mesh_builder.h"
#include "roomgraph/core/random.h"

namespace roomgraph {
namespace {

TEST(MaterialList, EqualMaterialsShareAnIndex) {
  MaterialList list;
  const Material red{"plain", {1, 0, 0}, 1, 0}, other_size{"plain", {1, 0, 0}, 2, 0};
  EXPECT_EQ(list.add(red), 0);
  EXPECT_EQ(list.add(other_size), 1);
  EXPECT_EQ(list.add(red), 0);
  ASSERT_EQ(list.all().size(), 2u);
  EXPECT_EQ(list.all()[1], other_size);
}

TEST(Mesh, MovesPositionsAndTurnsNormals) {
  MaterialList materials;
  MeshBuilder builder(materials);
  builder.use({"plain", {}, 1, 0}).box({1, 0, 0}, {0.2, 0.4, 0.6});
  const Mesh box = builder.take();
  // A quarter turn about z: (x, y) becomes (-y, x).
  const Mesh moved = box.moved(poseFromYpr(10, 20, 30, std::numbers::pi / 2, 0, 0));
  EXPECT_LT((moved.bounds().min() - Eigen::Vector3d(9.8, 20.9, 29.7)).norm(), 1e-5);
  EXPECT_LT((moved.bounds().max() - Eigen::Vector3d(10.2, 21.1, 30.3)).norm(), 1e-5);
  ASSERT_EQ(moved.triangles.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    const Eigen::Vector3f before = box.triangles[i].normal[0], after = moved.triangles[i].normal[0];
    EXPECT_LT((after - Eigen::Vector3f(-before.y(), before.x(), before.z())).norm(), 1e-6);
  }
  Mesh both = box;
  both.append(moved);
  EXPECT_EQ(both.triangles.size(), 24u);
  EXPECT_LT((both.bounds().max() - Eigen::Vector3d(10.2, 21.1, 30.3)).norm(), 1e-5);
}

/// Directed edges, corners rounded to 0.01 mm, that have no opposite: none in a closed surface.
int openEdges(const Mesh& mesh) {
  using Corner = std::array<long, 3>;
  std::map<std::pair<Corner, Corner>, int> balance;
  const auto rounded = [](const Eigen::Vector3f& p) {
    return Corner{std::lround(1e5 * p.x()), std::lround(1e5 * p.y()), std::lround(1e5 * p.z())};
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner a = rounded(t.position[i]), b = rounded(t.position[(i + 1) % 3]);
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  return static_cast<int>(
      std::count_if(balance.begin(), balance.end(), [](const auto& edge) { return edge.second != 0; }));
}

TEST(MeshBuilder, SolidsAreClosed) {
  MaterialList materials;
  const auto made = [&](auto&& build) {
    MeshBuilder builder(materials);
    build(builder.use({"plain", {}, 1, 0}));
    return openEdges(builder.take());
  };
  const Eigen::Vector3d center(0.3, -0.2, 0.5);
  EXPECT_EQ(made([&](MeshBuilder& m) { m.box(center, {1, 2, 3}); }), 0);
  EXPECT_EQ(made([&](MeshBuilder& m) { m.roundedBox(center, {1, 2, 3}, 0.2); }), 0);
  EXPECT_EQ(made([&](MeshBuilder& m) { m.roundedBox(center, {1, 2, 3}, 9); }), 0);  // the radius is cut to 0.5
  EXPECT_EQ(made([&](MeshBuilder& m) { m.ellipsoid(center, {1, 2, 3}); }), 0);
  EXPECT_EQ(made([&](MeshBuilder& m) { m.rod(center, {1, 1, 1}, 0.1, 0.2); }), 0);
  EXPECT_EQ(made([&](MeshBuilder& m) { m.capsule(center, {1, 1, 1}, 0.1, 0.2); }), 0);
  EXPECT_EQ(made([&](MeshBuilder& m) { m.lathe(center, {{0, 0}, {0.2, 0}, {0.3, 0.4}, {0, 0.4}}); }), 0);
  EXPECT_EQ(made([&](MeshBuilder& m) { m.quad({center, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}); }), 4);
}

TEST(MeshBuilder, ABodyOfRevolutionIsThatOfItsProfile) {
  MaterialList materials;
  MeshBuilder builder(materials);
  builder.use({"plain", {}, 1, 0}).lathe({1, 2, 3}, {{0, 0}, {0.3, 0}, {0.5, 0.4}, {0, 0.4}});
  const Mesh mesh = builder.take();
  double volume = 0;
  for (const auto& t : mesh.triangles)
    volume += (t.position[0] - Eigen::Vector3f(1, 2, 3)).dot((t.position[1] - Eigen::Vector3f(1, 2, 3))
                  .cross(t.position[2] - Eigen::Vector3f(1, 2, 3))) / 6;
  // Frustum of a cone; the inscribed prism of 14 sides has 14 sin(2 pi / 14) / (2 pi) of a circle's area.
  const double pi = std::numbers::pi, frustum = pi * 0.4 / 3 * (0.09 + 0.15 + 0.25);
  EXPECT_NEAR(volume, frustum * 7 / pi * std::sin(pi / 7), 1e-5);
  EXPECT_LT((mesh.bounds().max() - Eigen::Vector3d(1.5, 2.5, 3.4)).norm(), 0.02);
  // The slope's normals are at right angles to its profile, (0.2, 0.4).
  int slopes = 0;
  for (const auto& t : mesh.triangles)
    if (std::abs(t.normal[0].z()) < 0.9f) {
      ++slopes;
      EXPECT_NEAR(t.normal[0].head<2>().norm() * 0.2 + t.normal[0].z() * 0.4, 0, 1e-6);
    }
  EXPECT_EQ(slopes, 28);
}

TEST(MeshBuilder, TexturesKeepTheirSizeAndPicturesAreStretched) {
  MaterialList materials;
  MeshBuilder builder(materials);
  builder.use({"wood", {}, 0.25, 0}).box({3, 4, 5}, {1, 2, 3});
  for (const auto& t : builder.take().triangles)
    for (std::size_t i = 0; i < 3; ++i) {  // on a flat face the texture is isometric at its scale
      const std::size_t k = (i + 1) % 3;
      EXPECT_NEAR(0.25f * (t.uv[i] - t.uv[k]).norm(), (t.position[i] - t.position[k]).norm(), 1e-5);
    }
  MeshBuilder picture(materials);
  picture.use({"poster", {}, 0.25, 0}).frame(poseFromYpr(1, 1, 1, 0.5, 0, 0));
  const std::array<Eigen::Vector3d, 4> corners{Eigen::Vector3d(0, -1, 0), {0, 1, 0}, {0, 1, 3}, {0, -1, 3}};
  picture.quad(corners, true);
  const Mesh mesh = picture.take();
  const Pose3 back = poseFromYpr(1, 1, 1, 0.5, 0, 0).inverse();
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {  // u from left to right, v from top to bottom
      const Eigen::Vector3d p = back * t.position[i].cast<double>();
      EXPECT_NEAR(t.uv[i].x(), (p.y() + 1) / 2, 1e-6);
      EXPECT_NEAR(t.uv[i].y(), 1 - p.z() / 3, 1e-6);
    }
}

}  // namespace
}  // namespace roomgraph
