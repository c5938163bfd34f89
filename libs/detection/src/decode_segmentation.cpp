// SPDX-License-Identifier: BSD-3-Clause
// Boxes and masks from semantic segmentation logits by connected components.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "decoders.h"

namespace roomgraph {
namespace {

cv::Mat plane(const cv::Mat& logits, int channel) {
  return cv::Mat(logits.size[2], logits.size[3], CV_32FC1, const_cast<float*>(logits.ptr<float>(0, channel)));
}

// Per pixel: the index of the largest logit (CV_32SC1) and its softmax probability (CV_32FC1).
void winners(const cv::Mat& logits, cv::Mat& index, cv::Mat& probability) {
  cv::Mat top = plane(logits, 0).clone(), sum = cv::Mat::zeros(top.size(), CV_32FC1), part;
  index = cv::Mat::zeros(top.size(), CV_32SC1);
  for (int c = 1; c < logits.size[1]; ++c) {
    index.setTo(c, plane(logits, c) > top);
    cv::max(top, plane(logits, c), top);
  }
  for (int c = 0; c < logits.size[1]; ++c) {
    cv::exp(plane(logits, c) - top, part);
    sum += part;
  }
  probability = 1.0 / sum;
}

}  // namespace

std::vector<RawBox> decodeSegmentation(const cv::Mat& logits, cv::Size input, const std::vector<int>& wanted,
                                       double min_score, double min_area_ratio) {
  std::vector<RawBox> boxes;
  if (logits.dims != 4 || logits.type() != CV_32FC1 || logits.size[0] != 1) return boxes;
  cv::Mat index, probability, labels, stats, centroids;
  winners(logits, index, probability);
  const double scale_u = static_cast<double>(input.width) / index.cols;
  const double scale_v = static_cast<double>(input.height) / index.rows;
  for (const int wanted_class : wanted) {
    const int count = cv::connectedComponentsWithStats(index == wanted_class, labels, stats, centroids, 8);
    for (int k = 1; k < count; ++k) {
      if (stats.at<int>(k, cv::CC_STAT_AREA) < min_area_ratio * static_cast<double>(index.total())) continue;
      const cv::Mat component = labels == k;
      const double score = cv::mean(probability, component)[0];
      if (!(score >= min_score)) continue;
      const cv::Rect cells(stats.at<int>(k, cv::CC_STAT_LEFT), stats.at<int>(k, cv::CC_STAT_TOP),
                           stats.at<int>(k, cv::CC_STAT_WIDTH), stats.at<int>(k, cv::CC_STAT_HEIGHT));
      const Box2 box{cells.x * scale_u, cells.y * scale_v, cells.br().x * scale_u, cells.br().y * scale_v};
      boxes.push_back({box, wanted_class, score, component(cells).clone()});
    }
  }
  return boxes;
}

}  // namespace roomgraph
