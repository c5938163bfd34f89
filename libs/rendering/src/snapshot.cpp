// SPDX-License-Identifier: BSD-3-Clause
// Rendering by EGL at double size, overlay, and PNG encoding.
#include "roomgraph/rendering/snapshot.h"

#include <mrpt/opengl/CFBORender.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "overlay.h"
#include "picture.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "scene.h"

namespace roomgraph {
namespace {

constexpr int kLargestBuffer = 8192;  ///< px; what software renderers can do

int oversampling(const SnapshotOptions& options) {
  return 2 * std::max(options.width, options.height) <= kLargestBuffer ? 2 : 1;
}

/// OpenGL pads rows of pixels to four bytes, which CFBORender (MRPT 2.5) has no room for: it would write
/// behind its image.
SnapshotOptions withWholeRows(SnapshotOptions options) {
  const int step = 4 / oversampling(options);
  options.width = (options.width + step - 1) / step * step;
  return options;
}

/// BGR image of the scene, anti-aliased by rendering it at twice the size.
cv::Mat render(const mrpt::opengl::COpenGLScene& scene, const SnapshotOptions& options) {
  const int factor = oversampling(options);
  mrpt::img::CImage image;
  try {
    mrpt::opengl::CFBORender renderer(static_cast<unsigned>(factor * options.width),
                                      static_cast<unsigned>(factor * options.height));
    renderer.getCamera(scene) = scene.getViewport()->getCamera();
    renderer.render_RGB(scene, image);
  } catch (const std::exception&) {
    throw NoRenderer(
        "no off-screen renderer: it needs EGL with (software) OpenGL, packages libegl1 and libgl1-mesa-dri");
  }
  cv::Mat small;
  cv::resize(image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY), small, {options.width, options.height}, 0, 0,
             cv::INTER_AREA);
  return small;
}

}  // namespace

cv::Mat renderPicture(const MapPicture& picture, const ObjectDatabase& database,
                      const SnapshotOptions& options) {
  const SnapshotOptions wide = withWholeRows(options);
  const auto scene = buildScene(picture, database);
  const SceneView view(*scene, picture, wide, mapArea(picture, database, wide));
  cv::Mat image = render(*scene, wide);
  drawOverlay(image, picture, database, wide, view);
  return image(cv::Rect(0, 0, options.width, options.height)).clone();
}

void renderSnapshot(const CSemanticMap& map, const ObjectDatabase& database, const SnapshotOptions& options,
                    const std::filesystem::path& png) {
  const cv::Mat image = renderPicture(map, database, options);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  writeFileAtomically(png, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace roomgraph
