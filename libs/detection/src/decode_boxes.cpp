// SPDX-License-Identifier: BSD-3-Clause
// Decoding of NanoDet, YOLOX and Darknet outputs into boxes.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "decoders.h"

namespace roomgraph {
namespace {

struct Best {
  int index = -1;
  float score = 0;
};

Best bestOf(const float* scores, int count) {
  const float* best = std::max_element(scores, scores + count);
  return {static_cast<int>(best - scores), *best};
}

bool finite(const Box2& box) {
  return std::isfinite(box.u_min) && std::isfinite(box.v_min) && std::isfinite(box.u_max) &&
         std::isfinite(box.v_max);
}

// Expected value of a distribution given by its logits (softmax).
double expectedBin(const float* logits, int bins) {
  const float top = *std::max_element(logits, logits + bins);
  double sum = 0, weighted = 0;
  for (int i = 0; i < bins; ++i) {
    const double p = std::exp(static_cast<double>(logits[i] - top));
    sum += p;
    weighted += i * p;
  }
  return weighted / sum;
}

struct Cell {
  int row, column, stride;
};

// Calls `visit(anchor index, cell)` for every anchor of a grid pyramid; false when their number is not
// `anchors`.
template <std::size_t N>
bool forEachAnchor(const std::array<int, N>& strides, cv::Size input, int anchors,
                   const std::function<void(int, const Cell&)>& visit) {
  const auto cells = [](int size, int stride) { return (size + stride - 1) / stride; };
  int total = 0;
  for (const int stride : strides) total += cells(input.width, stride) * cells(input.height, stride);
  if (total != anchors) return false;
  int anchor = 0;
  for (const int stride : strides)
    for (int row = 0; row < cells(input.height, stride); ++row)
      for (int column = 0; column < cells(input.width, stride); ++column)
        visit(anchor++, {row, column, stride});
  return true;
}

void keepIfSound(std::vector<RawBox>& boxes, const RawBox& box) {
  if (finite(box.box) && !box.box.empty()) boxes.push_back(box);
}

}  // namespace

std::vector<RawBox> decodeNanodet(const cv::Mat& output, cv::Size input, int classes, double min_score,
                                  int bins) {
  std::vector<RawBox> boxes;
  if (output.dims != 2 || output.type() != CV_32FC1 || classes < 1 || output.cols != classes + 4 * bins)
    return boxes;
  forEachAnchor(std::array{8, 16, 32, 64}, input, output.rows, [&](int anchor, const Cell& cell) {
    const float* row = output.ptr<float>(anchor);
    const Best best = bestOf(row, classes);
    if (!(best.score >= min_score)) return;
    std::array<double, 4> side;  // left, top, right, bottom
    for (int k = 0; k < 4; ++k) side[k] = cell.stride * expectedBin(row + classes + k * bins, bins);
    const double u = cell.column * cell.stride, v = cell.row * cell.stride;
    keepIfSound(boxes, {{u - side[0], v - side[1], u + side[2], v + side[3]}, best.index, best.score, {}});
  });
  return boxes;
}

std::vector<RawBox> decodeYolox(const cv::Mat& output, cv::Size input, double min_score) {
  std::vector<RawBox> boxes;
  if (output.dims != 2 || output.type() != CV_32FC1 || output.cols < 6) return boxes;
  forEachAnchor(std::array{8, 16, 32}, input, output.rows, [&](int anchor, const Cell& cell) {
    const float* row = output.ptr<float>(anchor);
    const Best best = bestOf(row + 5, output.cols - 5);
    const double score = static_cast<double>(row[4]) * best.score;
    if (!(score >= min_score)) return;
    const double u = (row[0] + cell.column) * cell.stride, v = (row[1] + cell.row) * cell.stride;
    const double width = std::exp(row[2]) * cell.stride, height = std::exp(row[3]) * cell.stride;
    keepIfSound(boxes,
                {{u - width / 2, v - height / 2, u + width / 2, v + height / 2}, best.index, score, {}});
  });
  return boxes;
}

std::vector<RawBox> decodeDarknet(const cv::Mat& output, cv::Size input, double min_score) {
  std::vector<RawBox> boxes;
  if (output.dims != 2 || output.type() != CV_32FC1 || output.cols < 6) return boxes;
  for (int i = 0; i < output.rows; ++i) {
    const float* row = output.ptr<float>(i);
    const Best best = bestOf(row + 5, output.cols - 5);
    if (!(best.score >= min_score)) continue;
    const double u = row[0] * input.width, v = row[1] * input.height;
    const double width = row[2] * input.width, height = row[3] * input.height;
    keepIfSound(boxes,
                {{u - width / 2, v - height / 2, u + width / 2, v + height / 2}, best.index, best.score, {}});
  }
  return boxes;
}

}  // namespace roomgraph
