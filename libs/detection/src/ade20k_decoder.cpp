// SPDX-License-Identifier: BSD-3-Clause
// Connected components of the pixels of a class, with box, mask and mean probability.
#include "ade20k_decoder.h"

#include <opencv2/imgproc.hpp>

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(Ade20kDecoder, NetworkDecoder, roomgraph)

namespace {

constexpr double kLeastAreaShare = 0.004;  // of the image: smaller components are mostly errors

bool isLogits(const cv::Mat& blob) {
  return blob.dims == 4 && blob.type() == CV_32FC1 && blob.size[0] == 1;
}

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

void addComponents(const cv::Mat& logits, cv::Size input, const DecodingTask& task, std::vector<RawBox>& boxes) {
  cv::Mat index, probability, labels, stats, centroids;
  winners(logits, index, probability);
  const double scale_u = static_cast<double>(input.width) / index.cols;
  const double scale_v = static_cast<double>(input.height) / index.rows;
  for (const int wanted : task.wanted) {
    const int count = cv::connectedComponentsWithStats(index == wanted, labels, stats, centroids, 8);
    for (int k = 1; k < count; ++k) {
      if (stats.at<int>(k, cv::CC_STAT_AREA) < kLeastAreaShare * static_cast<double>(index.total())) continue;
      const cv::Mat component = labels == k;
      const double score = cv::mean(probability, component)[0];
      if (!(score >= task.min_score)) continue;
      const cv::Rect cells(stats.at<int>(k, cv::CC_STAT_LEFT), stats.at<int>(k, cv::CC_STAT_TOP),
                           stats.at<int>(k, cv::CC_STAT_WIDTH), stats.at<int>(k, cv::CC_STAT_HEIGHT));
      const Box2 box{cells.x * scale_u, cells.y * scale_v, cells.br().x * scale_u, cells.br().y * scale_v};
      boxes.push_back({box, wanted, score, component(cells).clone()});
    }
  }
}

}  // namespace

Preprocessing Ade20kDecoder::preprocessing() const {
  return {InputFit::kStretch, 0, true, cv::Scalar::all(127.5), cv::Scalar::all(127.5)};
}

bool Ade20kDecoder::recognises(const NetworkOutputs& outputs, int classes) const {
  return isLogits(outputs.blobs.front()) && outputs.blobs.front().size[1] == classes;
}

std::vector<RawBox> Ade20kDecoder::decode(const NetworkOutputs& outputs, const DecodingTask& task) const {
  std::vector<RawBox> boxes;
  for (const cv::Mat& blob : outputs.blobs)
    if (isLogits(blob)) addComponents(blob, outputs.input, task, boxes);
  return boxes;
}

}  // namespace roomgraph
