// SPDX-License-Identifier: BSD-3-Clause
// The semantic map in primitives of MRPT's OpenGL scenes.
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CText.h>

#include <algorithm>
#include <cstdio>

#include "detection_boxes.h"

namespace roomgraph {
namespace {

using mrpt::img::TColor;
using mrpt::math::TPoint3D;

constexpr double kLift_m = 0.02;  ///< above the grid, whose cells are at z = 0
constexpr double kThinnest_m = 0.05;
constexpr std::uint8_t kAlpha = 190;

TColor colorOf(const std::string& class_name, const ObjectDatabase* database) {
  const ObjectModel* model = database ? database->find(class_name) : nullptr;
  unsigned red = 0x88, green = 0x88, blue = 0x88;
  if (model && std::sscanf(model->color.c_str(), "#%2x%2x%2x", &red, &green, &blue) != 3)
    red = green = blue = 0x88;
  return {static_cast<std::uint8_t>(red), static_cast<std::uint8_t>(green), static_cast<std::uint8_t>(blue),
          kAlpha};
}

mrpt::opengl::CRenderizable::Ptr bodyOf(const ObjectShape& shape) {
  const float height = static_cast<float>(std::max(shape.height, kThinnest_m));
  if (shape.kind == ShapeKind::kCylinder) {
    const auto radius = static_cast<float>(shape.radius());
    return mrpt::opengl::CCylinder::Create(radius, radius, height, 24);
  }
  const double x = std::max(shape.depth, kThinnest_m) / 2, y = std::max(shape.width, kThinnest_m) / 2;
  auto box = mrpt::opengl::CBox::Create(TPoint3D(-x, -y, 0), TPoint3D(x, y, height));
  box->enableBoxBorder(true);
  return box;
}

// A triangle on the floor before the front.
mrpt::opengl::CSetOfTriangles::Ptr frontOf(const ObjectShape& shape) {
  const auto edge = static_cast<float>(shape.depth / 2);
  auto front = mrpt::opengl::CSetOfTriangles::Create();
  mrpt::opengl::TTriangle triangle(mrpt::math::TPoint3Df(edge + 0.25F, 0, 0),
                                   mrpt::math::TPoint3Df(edge + 0.1F, 0.1F, 0),
                                   mrpt::math::TPoint3Df(edge + 0.1F, -0.1F, 0));
  triangle.setColor(TColor(38, 46, 58));
  front->insertTriangle(triangle);
  return front;
}

mrpt::opengl::CSetOfObjects::Ptr drawn(const Landmark& landmark, const ObjectDatabase* database) {
  const std::string name = landmark.class_name + " " + std::to_string(landmark.id.value);
  auto object = mrpt::opengl::CSetOfObjects::Create();
  object->setName(name);
  const auto body = bodyOf(landmark.shape);
  body->setColor_u8(colorOf(landmark.class_name, database));
  object->insert(body);
  if (landmark.has_yaw) object->insert(frontOf(landmark.shape));
  auto label = mrpt::opengl::CText::Create(name);
  label->setLocation(0, 0, landmark.shape.height + 0.1);
  label->setColor_u8(TColor(38, 46, 58));
  object->insert(label);
  Pose3 pose = landmark.worldFromObject();
  pose.translation().z() += kLift_m;
  object->setPose(toMrpt(pose));
  return object;
}

mrpt::opengl::CSetOfLines::Ptr pathOf(const std::vector<StampedPose>& poses) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName("trajectory");
  lines->setColor_u8(TColor(92, 45, 160));
  lines->setLineWidth(2);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Vector3d from = poses[i - 1].pose.translation(), to = poses[i].pose.translation();
    lines->appendLine(from.x(), from.y(), from.z() + kLift_m, to.x(), to.y(), to.z() + kLift_m);
  }
  return lines;
}

}  // namespace

void CSemanticMap::getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const {
  if (!genericMapParams.enableSaveAs3DObject) return;
  if (occupancy) occupancy->getVisualizationInto(out);
  const auto database = databaseOf(*this);
  for (const Landmark& landmark : landmarks) out.insert(drawn(landmark, database.get()));
  if (world_from_robot.size() > 1) out.insert(pathOf(world_from_robot));
}

}  // namespace roomgraph
