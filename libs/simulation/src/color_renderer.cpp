// SPDX-License-Identifier: BSD-3-Clause
// MRPT scene graph of textured triangles, rendered at double size.
#include "color_renderer.h"

#include <mrpt/opengl/CFBORender.h>
#include <mrpt/opengl/CSetOfTexturedTriangles.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>

#include "roomgraph/core/errors.h"
#include "texture.h"

namespace roomgraph {
namespace {

using mrpt::opengl::CSetOfTexturedTriangles;
constexpr float kNear_m =
    0.2f;  ///< the depth buffer has few bits: near things would cost thin ones their place in front
constexpr float kFar_m = 60;
constexpr std::size_t kTextures = 190;  ///< MRPT 2.5 has 192 at a time
constexpr int kFine = 2;                ///< pictures are rendered at this multiple of their size and averaged

mrpt::opengl::TTriangle toMrpt(const MeshTriangle& triangle) {
  mrpt::opengl::TTriangle out;
  for (std::size_t i = 0; i < 3; ++i) {
    auto& vertex = out.vertices[i];
    vertex.xyzrgba.pt = {triangle.position[i].x(), triangle.position[i].y(), triangle.position[i].z()};
    vertex.normal = {triangle.normal[i].x(), triangle.normal[i].y(), triangle.normal[i].z()};
    vertex.uv = {triangle.uv[i].x(), triangle.uv[i].y()};
  }
  return out;
}

std::size_t materialsOf(const Mesh& mesh) {
  std::set<int> materials;
  for (const auto& triangle : mesh.triangles) materials.insert(triangle.material);
  return materials.size();
}

mrpt::img::TColor meanColor(const cv::Mat& bgr) {
  const cv::Scalar mean = cv::mean(bgr);
  const auto byte = [&](int channel) { return cv::saturate_cast<std::uint8_t>(mean[channel]); };
  return {byte(2), byte(1), byte(0)};
}

mrpt::img::TCamera finePinhole(const PinholeCamera& camera) {
  mrpt::img::TCamera out;
  out.ncols = static_cast<std::uint32_t>(kFine * camera.width);
  out.nrows = static_cast<std::uint32_t>(kFine * camera.height);
  // OpenGL counts from the picture's corner, the pinhole model from the centre of the first pixel.
  out.setIntrinsicParamsFromValues(kFine * camera.fx, kFine * camera.fy, kFine * (camera.cx + 0.5),
                                   kFine * (camera.cy + 0.5));
  return out;
}

}  // namespace

struct ColorRenderer::Content {
  Content(const Scene& scene, const PinholeCamera& camera);
  CSetOfTexturedTriangles::Ptr add(int material);
  using Drawables = std::map<int, CSetOfTexturedTriangles::Ptr>;  ///< by material
  void addTo(Drawables& drawables, const Mesh& mesh);
  void addMoving(std::size_t part);
  void addMovingPlain(std::size_t part);
  void place(const std::vector<Pose3>& world_from_part, const Pose3& world_from_camera, double nearest_m);

  const Scene& scene;
  PinholeCamera camera;
  std::vector<cv::Mat> textures;
  std::unique_ptr<mrpt::opengl::COpenGLScene> graph = std::make_unique<mrpt::opengl::COpenGLScene>();
  std::vector<std::pair<std::size_t, mrpt::opengl::CRenderizable::Ptr>> moving;  ///< part, drawable
  std::unique_ptr<mrpt::opengl::CFBORender> renderer;
};

CSetOfTexturedTriangles::Ptr ColorRenderer::Content::add(int material) {
  auto out = CSetOfTexturedTriangles::Create();
  out->assignImage(mrpt::img::CImage(textures[static_cast<std::size_t>(material)], mrpt::img::DEEP_COPY));
  out->enableTextureLinearInterpolation(true);
  graph->insert(out);
  return out;
}

void ColorRenderer::Content::addTo(Drawables& drawables, const Mesh& mesh) {
  for (const auto& triangle : mesh.triangles) {
    auto& drawable = drawables[triangle.material];
    if (!drawable) drawable = add(triangle.material);
    drawable->insertTriangle(toMrpt(triangle));
  }
}

void ColorRenderer::Content::addMoving(std::size_t part) {
  Drawables drawables;
  addTo(drawables, scene.parts()[part].mesh);
  for (const auto& [material, drawable] : drawables) moving.emplace_back(part, drawable);
}

// In the mean colours of its materials.
void ColorRenderer::Content::addMovingPlain(std::size_t part) {
  auto drawable = mrpt::opengl::CSetOfTriangles::Create();
  std::map<int, mrpt::img::TColor> colors;
  for (const auto& triangle : scene.parts()[part].mesh.triangles) {
    const auto [color, is_new] = colors.try_emplace(triangle.material);
    if (is_new) color->second = meanColor(textures[static_cast<std::size_t>(triangle.material)]);
    mrpt::opengl::TTriangle plain = toMrpt(triangle);
    plain.setColor(color->second);
    drawable->insertTriangle(plain);
  }
  graph->insert(drawable);
  moving.emplace_back(part, drawable);
}

ColorRenderer::Content::Content(const Scene& source, const PinholeCamera& model)
    : scene(source), camera(model) {
  for (const auto& material : scene.materials()) textures.push_back(textureOf(material));
  Drawables fixed;
  for (const auto& part : scene.parts())
    if (part.fixed) addTo(fixed, part.mesh);
  // A crowd has more textures than there may be: its last ones are of one colour each.
  std::size_t textured = fixed.size();
  for (std::size_t i = 0; i < scene.parts().size(); ++i) {
    const auto& part = scene.parts()[i];
    if (part.fixed) continue;
    const std::size_t needed = materialsOf(part.mesh);
    if (textured + needed > kTextures) {
      addMovingPlain(i);
    } else {
      addMoving(i);
      textured += needed;
    }
  }
  auto& light = graph->getViewport()->lightParameters();
  light.ambient = {0.7f, 0.7f, 0.7f, 1.f};
  light.diffuse = {0.45f, 0.45f, 0.45f, 1.f};
  light.specular = {0.f, 0.f, 0.f, 1.f};
  light.direction = mrpt::math::TVector3Df(-0.45f, 0.3f, -0.84f).unitarize();
  try {
    renderer = std::make_unique<mrpt::opengl::CFBORender>(static_cast<unsigned>(kFine * camera.width),
                                                          static_cast<unsigned>(kFine * camera.height));
  } catch (const std::exception& error) {
    const std::string what = error.what();
    throw RunError(
        "no off-screen renderer (EGL with software OpenGL: packages libegl1 and libgl1-mesa-dri): " +
        what.substr(0, what.find("Call stack")));
  }
}

void ColorRenderer::Content::place(const std::vector<Pose3>& world_from_part, const Pose3& world_from_camera,
                                   double nearest_m) {
  // The depth buffer has few bits: the nearer the clipping plane, the thicker a picture must be to stay
  // before its wall.
  graph->getViewport()->setViewportClipDistances(static_cast<float>(std::max(0.05, 0.9 * nearest_m)), kFar_m);
  for (const auto& [part, drawable] : moving) drawable->setPose(toMrpt(world_from_part[part]));
  mrpt::opengl::CCamera view;
  view.set6DOFMode(true);
  view.setProjectiveFromPinhole(finePinhole(camera));
  view.setPose(toMrpt(world_from_camera));
  renderer->setCamera(*graph, view);
}

ColorRenderer::ColorRenderer(const Scene& scene, const PinholeCamera& camera)
    : content_(std::make_unique<Content>(scene, camera)) {}
ColorRenderer::~ColorRenderer() = default;

cv::Mat ColorRenderer::render(const std::vector<Pose3>& world_from_part, const Pose3& world_from_camera,
                              double nearest_m) {
  content_->place(world_from_part, world_from_camera, nearest_m);
  mrpt::img::CImage fine;
  content_->renderer->render_RGB(*content_->graph, fine);
  cv::Mat out;
  cv::resize(fine.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY), out,
             {content_->camera.width, content_->camera.height}, 0, 0, cv::INTER_AREA);
  return out;
}

cv::Mat ColorRenderer::renderDepth(const std::vector<Pose3>& world_from_part, const Pose3& world_from_camera,
                                   double nearest_m) {
  content_->place(world_from_part, world_from_camera, nearest_m);
  mrpt::math::CMatrixFloat fine;
  content_->renderer->render_depth(*content_->graph, fine);
  cv::Mat out(content_->camera.height, content_->camera.width, CV_32F);
  // The centre of a pixel is the common corner of its fine pixels: their mean depth.
  for (int v = 0; v < out.rows; ++v) {
    for (int u = 0; u < out.cols; ++u) {
      float sum = 0;
      for (int k = 0; k < kFine * kFine; ++k) sum += fine(kFine * v + k / kFine, kFine * u + k % kFine);
      out.at<float>(v, u) = sum / (kFine * kFine);
    }
  }
  return out;
}

}  // namespace roomgraph
