// SPDX-License-Identifier: BSD-3-Clause
// Pixels of the back buffer to a PNG.
#include "screenshot.h"

#include <GL/gl.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "roomgraph/core/output_file.h"

namespace roomgraph {

void saveBackBuffer(int width, int height, const std::filesystem::path& png) {
  cv::Mat pixels(height, width, CV_8UC3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, width, height, GL_BGR, GL_UNSIGNED_BYTE, pixels.data);
  cv::flip(pixels, pixels, 0);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", pixels, bytes);
  writeFileAtomically(png, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::filesystem::path freePicture(const std::string& name) {
  int number = 1;
  std::filesystem::path file;
  do file = name + "_" + std::to_string(number++) + ".png";
  while (std::filesystem::exists(file));
  return file;
}

}  // namespace roomgraph
