// SPDX-License-Identifier: BSD-3-Clause
// Depth-buffered scan conversion of triangles, and silhouettes beyond the image border.
#include "id_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "parallel.h"

namespace roomgraph {
namespace {

constexpr double kNearPlane_m = 0.05;
constexpr int kMargin = 2;  ///< silhouettes are followed this many image sizes beyond the borders

struct ScreenTriangle {
  std::array<Eigen::Vector2d, 3> pixel;
  std::array<double, 3> inverse_depth;  ///< linear over the image
  int object;
};

void project(const std::array<Eigen::Vector3d, 3>& points, const PinholeCamera& camera, int object,
             std::vector<ScreenTriangle>& out) {
  // Clip at the near plane (Sutherland-Hodgman): up to four corners remain.
  std::array<Eigen::Vector3d, 4> corners;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &a = points[i], &b = points[(i + 1) % 3];
    if (a.z() >= kNearPlane_m) corners[count++] = a;
    if ((a.z() >= kNearPlane_m) != (b.z() >= kNearPlane_m)) {
      const double part = (kNearPlane_m - a.z()) / (b.z() - a.z());
      corners[count] = a + part * (b - a);
      corners[count++].z() = kNearPlane_m;
    }
  }
  for (std::size_t i = 2; i < count; ++i) {
    ScreenTriangle triangle;
    triangle.object = object;
    const Eigen::Vector3d* three[3] = {&corners[0], &corners[i - 1], &corners[i]};
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.pixel[k] = camera.project(*three[k]);
      triangle.inverse_depth[k] = 1 / three[k]->z();
    }
    out.push_back(triangle);
  }
}

/// Of a row of pixels in a triangle: 1/z at column u is that of its corners, weighted by at_0 + slope u.
struct RowWeights {
  std::array<double, 3> at_0, slope;
};

/// Calls visit(v, first, last, weights) for the rows of pixels of `area` whose centres lie in the triangle.
template <class Visit>
void scanRows(const ScreenTriangle& triangle, const cv::Rect& area, const Visit& visit) {
  const auto& p = triangle.pixel;
  const double det = (p[1] - p[0]).x() * (p[2] - p[0]).y() - (p[1] - p[0]).y() * (p[2] - p[0]).x();
  if (std::abs(det) < 1e-12) return;
  const auto low = [](double a, double b, double c) { return std::ceil(std::min({a, b, c})); };
  const auto high = [](double a, double b, double c) { return std::floor(std::max({a, b, c})); };
  const int v0 = static_cast<int>(std::max<double>(area.y, low(p[0].y(), p[1].y(), p[2].y())));
  const int v1 = static_cast<int>(std::min<double>(area.br().y - 1, high(p[0].y(), p[1].y(), p[2].y())));
  const double u_low = std::max<double>(area.x, low(p[0].x(), p[1].x(), p[2].x()));
  const double u_high = std::min<double>(area.br().x - 1, high(p[0].x(), p[1].x(), p[2].x()));
  // Barycentric weights are linear in u: solve for the span of every row instead of testing each pixel.
  const double w1_u = (p[2] - p[0]).y() / det, w2_u = -(p[1] - p[0]).y() / det;
  for (int v = v0; v <= v1; ++v) {
    const double dv = v - p[0].y();
    const double w1_0 = -(p[2] - p[0]).x() * dv / det - w1_u * p[0].x(),
                 w2_0 = (p[1] - p[0]).x() * dv / det - w2_u * p[0].x();
    double from = u_low, to = u_high;
    const RowWeights weights{{1 - w1_0 - w2_0, w1_0, w2_0}, {-w1_u - w2_u, w1_u, w2_u}};
    const auto& [at_0, slope] = weights;
    for (std::size_t k = 0; k < 3; ++k) {
      if (slope[k] > 0) from = std::max(from, std::ceil(-at_0[k] / slope[k]));
      if (slope[k] < 0) to = std::min(to, std::floor(-at_0[k] / slope[k]));
      if (slope[k] == 0 && at_0[k] < 0) to = from - 1;
    }
    if (from <= to) visit(v, static_cast<int>(from), static_cast<int>(to), weights);
  }
}

/// Calls visit(u, v, 1/z) for the pixels of `area` whose centres lie in the triangle.
template <class Visit>
void scan(const ScreenTriangle& triangle, const cv::Rect& area, const Visit& visit) {
  const auto& d = triangle.inverse_depth;
  scanRows(triangle, area, [&](int v, int first, int last, const RowWeights& weights) {
    const auto& [at_0, slope] = weights;
    for (int u = first; u <= last; ++u)
      visit(u, v,
            d[0] * (at_0[0] + slope[0] * u) + d[1] * (at_0[1] + slope[1] * u) +
                d[2] * (at_0[2] + slope[2] * u));
  });
}

std::vector<ScreenTriangle> screenTriangles(const Scene& scene, const std::vector<Pose3>& world_from_part,
                                            const Pose3& world_from_camera, const PinholeCamera& camera) {
  std::vector<ScreenTriangle> out;
  const Pose3 camera_from_world = world_from_camera.inverse();
  for (std::size_t i = 0; i < scene.parts().size(); ++i) {
    const ScenePart& part = scene.parts()[i];
    const Pose3 to_camera = camera_from_world * world_from_part[i];
    if ((to_camera * part.center).z() < -part.radius) continue;
    for (const auto& triangle : part.mesh.triangles) {
      std::array<Eigen::Vector3d, 3> points;
      for (std::size_t k = 0; k < 3; ++k) points[k] = to_camera * triangle.position[k].cast<double>();
      if (points[0].z() > kNearPlane_m || points[1].z() > kNearPlane_m || points[2].z() > kNearPlane_m)
        project(points, camera, part.object, out);
    }
  }
  return out;
}

struct Seen {
  int px = 0;
  int u0 = 1 << 30, v0 = 1 << 30, u1 = -(1 << 30), v1 = -(1 << 30);
  std::vector<float> depths;
  void add(int u, int v) {
    ++px;
    u0 = std::min(u0, u);
    v0 = std::min(v0, v);
    u1 = std::max(u1, u + 1);
    v1 = std::max(v1, v + 1);
  }
  cv::Rect box() const { return {u0, v0, u1 - u0, v1 - v0}; }
};

/// Compares the visible pixels with the object's whole silhouette, drawn alone on a canvas beyond the image.
ObjectView viewOf(int object, Seen& seen, const std::vector<const ScreenTriangle*>& triangles,
                  const cv::Size& image) {
  const cv::Rect canvas(-kMargin * image.width, -kMargin * image.height, (2 * kMargin + 1) * image.width,
                        (2 * kMargin + 1) * image.height);
  double u0 = 1e9, v0 = 1e9, u1 = -1e9, v1 = -1e9;
  for (const auto* triangle : triangles) {
    for (const auto& pixel : triangle->pixel) {
      u0 = std::min(u0, pixel.x());
      v0 = std::min(v0, pixel.y());
      u1 = std::max(u1, pixel.x());
      v1 = std::max(v1, pixel.y());
    }
  }
  const cv::Rect around =
      canvas &
      cv::Rect(cv::Point(static_cast<int>(std::max(u0, -1e6)) - 1, static_cast<int>(std::max(v0, -1e6)) - 1),
               cv::Point(static_cast<int>(std::min(u1, 1e6)) + 2, static_cast<int>(std::min(v1, 1e6)) + 2));
  cv::Mat covered = cv::Mat::zeros(around.size(), CV_8U);
  for (const auto* triangle : triangles)
    scanRows(*triangle, around, [&](int v, int first, int last, const RowWeights&) {
      std::memset(covered.ptr(v - around.y, first - around.x), 1, static_cast<std::size_t>(last - first + 1));
    });
  const int whole = cv::countNonZero(covered);
  const cv::Rect box = cv::boundingRect(covered) + around.tl();
  const int inside = cv::countNonZero(covered((cv::Rect({0, 0}, image) & around) - around.tl()));
  ObjectView out{object, seen.px, seen.box(), box, 0, 0, 0, 0};
  out.visible = static_cast<double>(seen.px) / whole;
  out.unoccluded = static_cast<double>(seen.px) / inside;
  out.in_frame = static_cast<double>(inside) / whole;
  const auto middle = seen.depths.begin() + static_cast<std::ptrdiff_t>(seen.depths.size() / 2);
  std::nth_element(seen.depths.begin(), middle, seen.depths.end());
  out.median_depth_m = *middle;
  return out;
}

void measureViews(const std::vector<ScreenTriangle>& triangles, std::size_t objects, IdImage& image) {
  std::vector<Seen> seen(objects);
  for (int v = 0; v < image.object.rows; ++v) {
    for (int u = 0; u < image.object.cols; ++u) {
      const int object = image.object.at<short>(v, u);
      if (object < 0) continue;
      auto& item = seen[static_cast<std::size_t>(object)];
      item.add(u, v);
      item.depths.push_back(image.depth.at<float>(v, u));
    }
  }
  std::vector<std::vector<const ScreenTriangle*>> own(objects);
  for (const auto& triangle : triangles)
    if (triangle.object >= 0 && seen[static_cast<std::size_t>(triangle.object)].px > 0)
      own[static_cast<std::size_t>(triangle.object)].push_back(&triangle);
  std::vector<ObjectView> views(objects);
  parallelFor(std::size_t{0}, objects, [&](std::size_t i) {
    if (seen[i].px > 0) views[i] = viewOf(static_cast<int>(i), seen[i], own[i], image.depth.size());
  });
  for (const auto& view : views)
    if (view.px > 0) image.views.push_back(view);
}

}  // namespace

IdImage rasterize(const Scene& scene, const std::vector<Pose3>& world_from_part,
                  const Pose3& world_from_camera, const PinholeCamera& camera) {
  const auto triangles = screenTriangles(scene, world_from_part, world_from_camera, camera);
  cv::Mat inverse = cv::Mat::zeros(camera.height, camera.width, CV_32F);
  IdImage out;
  out.object = cv::Mat(camera.height, camera.width, CV_16S, cv::Scalar(-1));
  constexpr int kBand = 60;  // rows; each band belongs to one thread
  parallelFor(0, (camera.height + kBand - 1) / kBand, [&](int band) {
    const cv::Rect area(0, band * kBand, camera.width, std::min(kBand, camera.height - band * kBand));
    for (const auto& triangle : triangles) {
      scan(triangle, area, [&](int u, int v, double inverse_depth) {
        float& best = inverse.at<float>(v, u);
        if (static_cast<float>(inverse_depth) <= best) return;
        best = static_cast<float>(inverse_depth);
        out.object.at<short>(v, u) = static_cast<short>(triangle.object);
      });
    }
  });
  out.depth = cv::Mat::zeros(camera.height, camera.width, CV_32F);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      if (inverse.at<float>(v, u) > 0) out.depth.at<float>(v, u) = 1 / inverse.at<float>(v, u);
  measureViews(triangles, scene.objects().size(), out);
  return out;
}

}  // namespace roomgraph
