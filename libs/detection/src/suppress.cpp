// SPDX-License-Identifier: BSD-3-Clause
// Greedy suppression by intersection over union.
#include "suppress.h"

#include <algorithm>
#include <Eigen/Core>
#include <map>
#include <opencv2/dnn.hpp>
#include <tuple>
#include <utility>

namespace roomgraph {
namespace {

constexpr double kSameThing = 0.7;  // IoU of boxes with different labels

// The first of the boxes, with the others' say; the box of a mask keeps its sides.
RawBox fused(const std::vector<RawBox>& boxes, const std::vector<int>& thing) {
  RawBox out = boxes[thing.front()];
  double all = 0, none_right = 1;
  Eigen::Vector4d sides = Eigen::Vector4d::Zero();
  for (const int i : thing) {
    const auto& [box, score] = std::tie(boxes[i].box, boxes[i].score);
    sides += score * Eigen::Vector4d(box.u_min, box.v_min, box.u_max, box.v_max);
    all += score;
    none_right *= 1 - score;
  }
  sides /= all;
  out.box = {sides[0], sides[1], sides[2], sides[3]};
  out.score = 1 - none_right;
  const auto masked = std::find_if(thing.begin(), thing.end(), [&](int i) { return !boxes[i].mask.empty(); });
  if (masked == thing.end()) return out;
  out.box = boxes[*masked].box;  // which the mask covers
  out.mask = boxes[*masked].mask;
  return out;
}

}  // namespace

std::vector<int> suppressPerClass(const std::vector<RawBox>& boxes, double max_iou) {
  std::map<std::pair<int, int>, std::vector<int>> by_class;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
    by_class[{boxes[i].class_index, boxes[i].network}].push_back(i);
  std::vector<int> kept;
  for (const auto& [key, members] : by_class) {
    std::vector<cv::Rect2d> rects;
    std::vector<float> scores;
    for (const int i : members) {
      const Box2& box = boxes[i].box;
      rects.emplace_back(box.u_min, box.v_min, box.width(), box.height());
      scores.push_back(static_cast<float>(boxes[i].score));
    }
    std::vector<int> chosen;
    cv::dnn::NMSBoxes(rects, scores, 0.f, static_cast<float>(max_iou), chosen);
    for (const int k : chosen) kept.push_back(members[k]);
  }
  std::stable_sort(kept.begin(), kept.end(), [&](int a, int b) { return boxes[a].score > boxes[b].score; });
  return kept;
}

std::vector<int> fuseNetworks(std::vector<RawBox>& boxes, const std::vector<int>& kept, double max_iou) {
  std::vector<std::vector<int>> things;  // indices, best first
  for (const int i : kept) {
    const auto same = std::find_if(things.begin(), things.end(), [&](const std::vector<int>& thing) {
      const RawBox& best = boxes[thing.front()];
      return best.network != boxes[i].network && best.class_index == boxes[i].class_index &&
             iou(best.box, boxes[i].box) > max_iou;
    });
    if (same == things.end())
      things.push_back({i});
    else if (std::none_of(same->begin(), same->end(), [&](int k) { return boxes[k].network == boxes[i].network; }))
      same->push_back(i);  // else its network has said so already, by a better box
  }
  std::vector<int> out;
  for (const auto& thing : things) {
    out.push_back(thing.front());
    if (thing.size() > 1) boxes[thing.front()] = fused(boxes, thing);
  }
  std::stable_sort(out.begin(), out.end(), [&](int a, int b) { return boxes[a].score > boxes[b].score; });
  return out;
}

std::vector<int> suppressTwins(const std::vector<RawBox>& boxes, const std::vector<int>& kept,
                               double max_iou) {
  std::vector<int> out;
  for (const int i : kept) {
    const bool twin = std::any_of(out.begin(), out.end(), [&](int better) {
      return boxes[better].class_index != boxes[i].class_index &&
             iou(boxes[better].box, boxes[i].box) > max_iou;
    });
    if (!twin) out.push_back(i);
  }
  return out;
}

void setRivals(std::vector<Detection>& detections, const std::vector<Detection>& others,
               const ObjectDatabase& database) {
  const auto mapped = [&database](const Detection& d) {
    const ObjectModel* model = database.find(d.class_name);
    return model && model->landmark;
  };
  std::vector<const Detection*> rivals;
  for (const auto& other : others) rivals.push_back(&other);
  for (const auto& detection : detections)
    if (!mapped(detection)) rivals.push_back(&detection);
  for (auto& detection : detections) {
    if (!mapped(detection)) continue;
    for (const Detection* rival : rivals) {
      if (rival->score <= detection.rival_score || iou(rival->box, detection.box) <= kSameThing) continue;
      detection.rival_score = rival->score;
      detection.rival_label = rival->class_name.empty() ? rival->label : "";
    }
  }
}

}  // namespace roomgraph
