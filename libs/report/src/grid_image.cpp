// SPDX-License-Identifier: BSD-3-Clause
// Grid cells to grey levels, reduced by blocks when there are too many; views shrunk.
#include "grid_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "roomgraph/core/text_file.h"
#include "roomgraph/mapping/map_files.h"

namespace roomgraph {
namespace {

constexpr unsigned char kOccupied = 0, kUnknown = 128, kFree = 255;

unsigned char greyOf(float p_free) {
  if (p_free < 0.25f) return kOccupied;
  return p_free > 0.75f ? kFree : kUnknown;
}

// Occupied if any cell of the block is, else free if any is.
unsigned char blockOf(const mrpt::maps::COccupancyGridMap2D& grid, int x, int y, int side) {
  unsigned char out = kUnknown;
  for (int dy = 0; dy < side; ++dy)
    for (int dx = 0; dx < side; ++dx) {
      const int cx = x * side + dx, cy = y * side + dy;
      if (cx >= static_cast<int>(grid.getSizeX()) || cy >= static_cast<int>(grid.getSizeY())) continue;
      const unsigned char grey = greyOf(grid.getCell(cx, cy));
      if (grey == kOccupied) return kOccupied;
      if (grey == kFree) out = kFree;
    }
  return out;
}

std::string encoded(const cv::Mat& image, const char* ending) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(ending, image, bytes)) throw InputError("a picture cannot be encoded");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

GridImage readGridImage(const std::filesystem::path& yaml, double most_cells) {
  const auto [grid, origin] = loadOccupancyRos(yaml);
  const int width = static_cast<int>(grid.getSizeX()), height = static_cast<int>(grid.getSizeY());
  const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(1. * width * height / most_cells))));
  GridImage out;
  out.width = (width + side - 1) / side;
  out.height = (height + side - 1) / side;
  out.cell_m = grid.getResolution() * side;
  out.x_min = origin.x();
  out.y_min = origin.y();
  cv::Mat image(out.height, out.width, CV_8U);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      image.at<unsigned char>(out.height - 1 - y, x) = blockOf(grid, x, y, side);
  out.png = encoded(image, ".png");
  return out;
}

}  // namespace roomgraph
