// SPDX-License-Identifier: BSD-3-Clause
// Mesh files in place of built furniture: fit, orientation, material, broken files.
#include <gmock/gmock.h>

#include "errors_of.h"
#include "example_world.h"
#include "roomgraph/core/errors.h"
#include "scene.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A wedge of 2 x 3 x 4 (x, y up, z to the front) whose high edge is at the back.
constexpr const char* kWedge = R"(mtllib wedge.mtl
v 0 0 0
v 2 0 0
v 2 0 4
v 0 0 4
v 0 3 0
v 2 3 0
usemtl red
f 1 2 3 4
f 5 4 3 6
f 1 5 6 2
f 1 4 5
f 2 6 3
)";

struct MeshWorld {
  test::TemporaryFolder folder;
  std::filesystem::path file;
  MeshWorld() {
    folder.write("wedge.obj", kWedge);
    folder.write("wedge.mtl", "newmtl red\nKd 0.8 0.1 0.1\n");
    file = folder.write("w.json",
                        test::changed("\"model\": \"block\",",
                                         "\"model\": \"sofa\", \"mesh\": \"wedge.obj\", \"yaw_deg\": 90,"));
  }
};

TEST(MeshFile, ReplacesFurnitureFittedAndTurned) {
  const MeshWorld example;
  const Scene scene(readWorld(example.file));
  const auto& object = scene.objects()[0];
  EXPECT_EQ(object.class_name, "sofa");
  EXPECT_EQ(object.model, "mesh:wedge");
  const auto& part = scene.parts()[1];
  ASSERT_EQ(part.object, 0);
  const auto box = part.mesh.bounds();
  // w 0.6, d 0.4, h 1.0, turned by 90 degrees: the depth lies along y.
  EXPECT_LT((box.sizes() - Eigen::Vector3d(0.6, 0.4, 1.0)).norm(), 1e-4);
  EXPECT_LT((box.min() - Eigen::Vector3d(3.2, 0.3, 0)).norm(), 1e-4);
  for (const auto& triangle : part.mesh.triangles) {
    for (const auto& corner : triangle.position) {
      if (corner.z() > 0.9f) {
        EXPECT_NEAR(corner.y(), 0.3, 1e-4);  // the high edge is opposite to the front, +y
      }
    }
    const auto& material = scene.materials()[static_cast<std::size_t>(triangle.material)];
    EXPECT_NEAR(material.rgb[0], 0.8, 0.01);
    EXPECT_NEAR(material.rgb[1], 0.1, 0.01);
  }
}

TEST(MeshFile, AMissingOrBrokenFileIsNamed) {
  const MeshWorld example;
  std::filesystem::remove(example.folder.file("wedge.obj"));
  EXPECT_THAT(test::messageOf<ConfigError>([&] { readWorld(example.file); }),
              AllOf(HasSubstr("furniture[0].mesh"), HasSubstr("wedge.obj")));
  example.folder.write("wedge.obj", "not a mesh");
  EXPECT_THAT(test::messageOf<InputError>([&] { Scene scene(readWorld(example.file)); }),
              HasSubstr("wedge.obj"));
}

}  // namespace
}  // namespace roomgraph
