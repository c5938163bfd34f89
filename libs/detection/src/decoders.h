// SPDX-License-Identifier: BSD-3-Clause
// Decoders of network outputs into boxes, and non-maximum suppression.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

#include "roomgraph/geometry/box.h"

namespace roomgraph {

/// A box as a network gave it, before non-maximum suppression.
struct RawBox {
  Box2 box;  ///< px of the network's input
  int class_index = -1;
  double score = 0;
  cv::Mat mask;  ///< CV_8UC1 (0 / 255) over the box at the network's own resolution, or empty
};

/// NanoDet-Plus: `output` N x (C + 4 (B + 1)) of 32-bit floats; C sigmoid scores, then for left, top, right,
/// bottom a distribution over B + 1 = `bins` distances in strides. Anchors row by row, strides 8, 16, 32, 64;
/// centre = index times stride. Nothing comes out for a blob whose size fits neither the input nor the class
/// count.
std::vector<RawBox> decodeNanodet(const cv::Mat& output, cv::Size input, int classes, double min_score,
                                  int bins = 8);

/// YOLOX: `output` N x (5 + C): centre offset (strides), log size (strides), objectness, class scores;
/// strides 8, 16, 32; score = objectness x class score.
std::vector<RawBox> decodeYolox(const cv::Mat& output, cv::Size input, double min_score);

/// Darknet region layers as OpenCV gives them: `output` N x (5 + C): centre, size relative to the input,
/// objectness, class scores already multiplied by it.
std::vector<RawBox> decodeDarknet(const cv::Mat& output, cv::Size input, double min_score);

/// Semantic segmentation: `logits` 1 x C x H x W. One box per 8-connected component of pixels whose largest
/// logit is a wanted class, with its mask; score = mean softmax probability of the class over the component.
/// Components smaller than `min_area_ratio` of the picture are left out.
std::vector<RawBox> decodeSegmentation(const cv::Mat& logits, cv::Size input, const std::vector<int>& wanted,
                                       double min_score, double min_area_ratio = 0.004);

/// Indices of the boxes that survive non-maximum suppression within their own class, best score first.
std::vector<int> suppressPerClass(const std::vector<RawBox>& boxes, double max_iou);

/// Of `kept` (indices, best first) those that are not nearly the same box as a better one of another class:
/// one object that got two labels.
std::vector<int> suppressTwins(const std::vector<RawBox>& boxes, const std::vector<int>& kept,
                               double max_iou);

/// Name of a COCO-80 class index ("person" … "toothbrush"); empty when out of range.
const char* cocoLabel(int index);

}  // namespace roomgraph
