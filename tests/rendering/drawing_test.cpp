// SPDX-License-Identifier: BSD-3-Clause
// Colours, text and triangles that pictures are made of, against closed forms.
#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/core.hpp>

#include "glyphs.h"
#include "roomgraph/rendering/palette.h"
#include "roomgraph/rendering/triangle_set.h"
#include "wireframe.h"

namespace roomgraph {
namespace {

using palette::TColor;

TEST(Palette, MixIsLinearAndKeepsItsEnds) {
  const TColor a(10, 200, 30, 255), b(110, 100, 230, 55);
  EXPECT_EQ(palette::mix(a, b, 0), a);
  EXPECT_EQ(palette::mix(a, b, 1), b);
  EXPECT_EQ(palette::mix(a, b, 0.25), TColor(35, 175, 80, 205));
  EXPECT_EQ(palette::withAlpha(a, 7), TColor(10, 200, 30, 7));
}

TEST(Palette, ColoursOfClassesAreHexadecimalOrGrey) {
  EXPECT_EQ(palette::parse("#e6862A"), TColor(0xe6, 0x86, 0x2a));
  for (const std::string text : {"", "e6862a", "#e6862", "#e6862g", "#e6862a0"})
    EXPECT_EQ(palette::parse(text), TColor(136, 136, 136)) << text;
  const auto objects = ObjectDatabase::fromText("[sofa]\nlabels=couch\ncolor=#102030\n");
  EXPECT_EQ(palette::ofClass(objects, "sofa"), TColor(16, 32, 48));
  EXPECT_EQ(palette::ofClass(objects, "lamp"), TColor(136, 136, 136));
}

/// Bounds of the pixels darker than mid grey, and how many there are.
std::pair<cv::Rect, int> inkOf(const cv::Mat& image) {
  cv::Rect bounds;
  int count = 0;
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      if (image.at<cv::Vec3b>(v, u)[1] < 128) {
        bounds = count++ == 0 ? cv::Rect(u, v, 1, 1) : bounds | cv::Rect(u, v, 1, 1);
      }
  return {bounds, count};
}

TEST(Glyphs, TextStandsOnItsBaseLineInTheSizeAskedFor) {
  for (const double height : {12.0, 30.0}) {
    cv::Mat image(120, 400, CV_8UC3, cv::Scalar(255, 255, 255));
    const TextStyle style{height, TColor(0, 0, 0), 0};
    drawText(image, "HIH", {40, 80}, style);
    const auto [box, count] = inkOf(image);
    EXPECT_NEAR(box.height, height, 1.5);
    EXPECT_NEAR(box.br().y, 80, 1.5);
    EXPECT_GE(box.x, 39);
    EXPECT_NEAR(box.br().x, 40 + textWidth("HIH", style), 2);
    EXPECT_GT(count, box.area() / 8);
  }
  const TextStyle small{10, {}, 0}, large{25, {}, 0};
  EXPECT_NEAR(textWidth("some text", large), 2.5 * textWidth("some text", small), 1e-6);
  EXPECT_GT(textWidth("some text", small), textWidth("some", small));
}

TEST(Glyphs, LettersOfOtherLanguagesAreLetters) {
  const TextStyle style{20, TColor(0, 0, 0), 0};
  EXPECT_NEAR(textWidth("B\u00fcro", style), textWidth("Buro", style), 0.2 * textWidth("Buro", style));
  EXPECT_NEAR(textWidth("\u00fc\u00fc", style), 2 * textWidth("\u00fc", style), 1e-6);
  EXPECT_GT(textWidth("\xff", style), 0) << "no text at all";
  cv::Mat image(120, 400, CV_8UC3, cv::Scalar(255, 255, 255));
  drawText(image, "H\u00c4H", {40, 80}, style);
  const auto [box, count] = inkOf(image);
  EXPECT_NEAR(box.br().y, 80, 1.5);
  EXPECT_GT(box.height, 22) << "dots above";
  EXPECT_LT(box.height, 32);
  EXPECT_NEAR(box.br().x, 40 + textWidth("H\u00c4H", style), 4);
  EXPECT_GT(count, box.area() / 8);
}

TEST(Glyphs, AHaloSurroundsTheLettersAndOnlyThem) {
  cv::Mat image(80, 200, CV_8UC3, cv::Scalar(0, 0, 0));
  drawText(image, "H", {90, 50}, {20, TColor(0, 0, 255), 4});
  EXPECT_GT(image.at<cv::Vec3b>(40, 88)[1], 100) << "white beside the letter";
  EXPECT_EQ(image.at<cv::Vec3b>(40, 60), cv::Vec3b(0, 0, 0)) << "nothing far from it";
  cv::Mat bare(80, 200, CV_8UC3, cv::Scalar(0, 0, 0));
  drawText(bare, "H", {90, 50}, {20, TColor(0, 0, 255), 0});
  double green = 0;
  cv::minMaxLoc(bare.reshape(1, 80 * 200).col(1), nullptr, &green);
  EXPECT_EQ(green, 0) << "no white without a halo";
  drawText(image, "cut off", {-30, 2}, {20, {}, 3});
  drawText(image, "cut off", {180, 79}, {20, {}, 3});  // must not write outside
}

/// Sum of the triangles' areas, m^2.
double areaOf(const mrpt::opengl::CSetOfTriangles& triangles) {
  double sum = 0;
  for (std::size_t i = 0; i < triangles.getTrianglesCount(); ++i) {
    mrpt::opengl::TTriangle t;
    triangles.getTriangle(i, t);
    const auto at = [&](std::size_t k) {
      return Eigen::Vector3d(static_cast<double>(t.x(k)), static_cast<double>(t.y(k)), static_cast<double>(t.z(k)));
    };
    sum += (at(1) - at(0)).cross(at(2) - at(0)).norm() / 2;
  }
  return sum;
}

TEST(TriangleSet, ShapesHaveTheirAreas) {
  const auto made = [](auto&& draw) {
    TriangleSet set;
    draw(set);
    return areaOf(*set.object("x"));
  };
  const double pi = std::numbers::pi;
  // Regular pentagon of radius 2, a ribbon across the plane, a disc of 12 sides.
  std::vector<Eigen::Vector3d> pentagon;
  for (int i = 0; i < 5; ++i) pentagon.emplace_back(2 * std::cos(0.4 * pi * i), 2 * std::sin(0.4 * pi * i), 1);
  EXPECT_NEAR(made([&](TriangleSet& s) { s.polygon(pentagon, {}); }), 5 * 2 * std::sin(0.4 * pi), 1e-4);
  EXPECT_NEAR(made([&](TriangleSet& s) { s.ribbon({1, 1, 0}, {4, 5, 0}, 0.2, {}); }), 5 * 0.2, 1e-5);
  EXPECT_NEAR(made([&](TriangleSet& s) { s.disc({1, 2, 3}, 0.5, {}); }), 12 * 0.125 * std::sin(pi / 6), 1e-5);
  EXPECT_EQ(made([&](TriangleSet& s) { s.ribbon({1, 1, 0}, {1, 1, 5}, 0.2, {}); }), 0) << "upright: no width";
  const std::vector<Eigen::Vector3d> square{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};
  EXPECT_NEAR(made([&](TriangleSet& s) { s.outline(square, 0.1, {}); }),
              4 * (3 * 0.1 + 8 * 0.05 * 0.05 / 2 * std::sin(pi / 4)), 1e-5);
}

TEST(TriangleSet, KeepsColoursAndName) {
  TriangleSet set;
  set.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, TColor(1, 2, 3, 4));
  const auto object = set.object("some name");
  EXPECT_EQ(object->getName(), "some name");
  mrpt::opengl::TTriangle t;
  object->getTriangle(0, t);
  for (const auto& vertex : t.vertices)
    EXPECT_EQ(TColor(vertex.xyzrgba.r, vertex.xyzrgba.g, vertex.xyzrgba.b, vertex.xyzrgba.a), TColor(1, 2, 3, 4));
}

TEST(Wireframe, TheGroundGridLiesOnTheGroundInWholeMetres) {
  const PinholeCamera camera{640, 480, 525, 525, 319.5, 239.5, {}};
  Pose3 world_from_camera = poseFromYpr(1, 2, 1.1, 0.8, 0.3, 0.05);
  world_from_camera.linear() = world_from_camera.linear() * bodyFromOptical();
  const Plane ground = groundInCamera(world_from_camera);
  const Pose3 ground_from_camera = cameraFromGround(ground).inverse();
  const auto grid = groundGrid(ground, camera, 4);
  EXPECT_GT(grid.size(), 8u);
  const auto onGround = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
    const Eigen::Vector3d ray = camera.ray(pixel.x(), pixel.y());
    // Intersection with n . p + d = 0, whatever the sign convention: the ground frame has it at z = 0.
    const Eigen::Vector3d from = ground_from_camera.translation(), along = ground_from_camera.linear() * ray;
    return (from - from.z() / along.z() * along).head<2>();
  };
  for (const auto& segment : grid) {
    const Eigen::Vector2d a = onGround(segment.a), b = onGround(segment.b);
    // One coordinate is the same whole number at both ends.
    const int axis = std::abs(a.x() - b.x()) < std::abs(a.y() - b.y()) ? 0 : 1;
    EXPECT_NEAR(a[axis], b[axis], 1e-6);
    EXPECT_NEAR(a[axis], std::round(a[axis]), 1e-6);
    EXPECT_LE(std::abs(a[axis]), 4 + 1e-6);
  }
}

}  // namespace
}  // namespace roomgraph
