// SPDX-License-Identifier: BSD-3-Clause
// Greedy matching by score and IoU with ignore regions, and the precision envelope.
#include "roomgraph/evaluation/detection_error.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace roomgraph {
namespace {

constexpr const char* kOther = "other";

double share(double part, double whole) {
  return whole > 0 ? part / whole : 0;
}

struct Scored {
  double score;
  bool correct;
};

// Counts of one class over all frames.
struct ClassTally {
  std::vector<Scored> scored;  // detections that are right or wrong
  int truths = 0, ignored = 0;
};

// Area under the precision envelope: at each recall the largest precision of this or a higher recall. Equal scores make
// one step, so that the order of the detections does not matter.
double averagePrecision(std::vector<Scored> scored, int truths) {
  if (truths == 0) return 0;
  std::sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) { return a.score > b.score; });
  std::vector<std::pair<double, double>> curve;  // recall, precision
  int correct = 0;
  for (std::size_t i = 0; i < scored.size(); ++i) {
    correct += scored[i].correct;
    if (i + 1 < scored.size() && scored[i + 1].score == scored[i].score) continue;
    curve.emplace_back(share(correct, truths), share(correct, static_cast<double>(i + 1)));
  }
  double area = 0, envelope = 0;
  for (std::size_t i = curve.size(); i-- > 0;) {
    envelope = std::max(envelope, curve[i].second);
    area += (curve[i].first - (i > 0 ? curve[i - 1].first : 0)) * envelope;
  }
  return area;
}

// The true boxes of one frame that concern one class.
struct ClassView {
  std::vector<Box2> counted, regions;
};

ClassView viewOf(const TrueFrame& frame, const std::string& name, const DetectionOptions& options) {
  ClassView view;
  for (const auto& truth : frame.boxes) {
    if (truth.class_name == name) {
      const bool counts = truth.visible > options.min_visible && truth.box.height() > options.min_height_px;
      (counts ? view.counted : view.regions).push_back(truth.box);
    } else if (isForgiven(options.forgiven_kinds, name, truth.class_name, truth.kind)) {
      view.regions.push_back(truth.box);
    }
  }
  return view;
}

std::vector<DetectedBox> ofClass(const DetectedFrame& frame, const std::string& name, double min_score) {
  std::vector<DetectedBox> boxes;
  for (const auto& box : frame.boxes)
    if (box.class_name == name && box.score >= min_score) boxes.push_back(box);
  const auto key = [](const DetectedBox& b) {
    return std::make_tuple(-b.score, b.box.u_min, b.box.v_min, b.box.u_max, b.box.v_max);
  };
  std::sort(boxes.begin(), boxes.end(),
            [&](const DetectedBox& a, const DetectedBox& b) { return key(a) < key(b); });
  return boxes;
}

// Index of the free box with the highest IoU, -1: none reaches the threshold.
int bestFree(const std::vector<Box2>& boxes, const std::vector<char>& taken, const Box2& detected,
             double min_iou) {
  int best = -1;
  double highest = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double overlap = iou(boxes[i], detected);
    if (taken[i] || overlap < min_iou || overlap <= highest) continue;
    best = static_cast<int>(i);
    highest = overlap;
  }
  return best;
}

void compareFrame(const ClassView& view, const std::vector<DetectedBox>& detections,
                  const DetectionOptions& options, ClassTally& tally) {
  std::vector<char> taken(view.counted.size(), 0);
  tally.truths += static_cast<int>(view.counted.size());
  for (const auto& detection : detections) {
    const int match = bestFree(view.counted, taken, detection.box, options.min_iou);
    if (match >= 0) taken[static_cast<std::size_t>(match)] = 1;
    const bool in_region = std::any_of(view.regions.begin(), view.regions.end(), [&](const Box2& region) {
      return share(intersection(region, detection.box).area(), detection.box.area()) >= options.min_iou;
    });
    if (match < 0 && in_region) {
      ++tally.ignored;
    } else {
      tally.scored.push_back({detection.score, match >= 0});
    }
  }
}

void setShares(DetectionFigures& f) {
  f.precision = share(f.correct, f.correct + f.false_alarms);
  f.recall = share(f.correct, f.correct + f.missed);
  f.f1 = share(2 * f.correct, 2 * f.correct + f.false_alarms + f.missed);
}

DetectionFigures figuresOf(const ClassTally& tally) {
  DetectionFigures out;
  for (const auto& scored : tally.scored) ++(scored.correct ? out.correct : out.false_alarms);
  out.missed = tally.truths - out.correct;
  out.ignored = tally.ignored;
  out.ap = averagePrecision(tally.scored, tally.truths);
  setShares(out);
  return out;
}

void summarizeClasses(DetectionErrors& out) {
  int with_truth = 0, with_detections = 0;
  for (const auto& [name, f] : out.per_class) {
    out.all.correct += f.correct;
    out.all.false_alarms += f.false_alarms;
    out.all.missed += f.missed;
    out.all.ignored += f.ignored;
    out.all.ap += f.ap;
    out.mean_precision += f.precision;
    out.mean_recall += f.recall;
    with_truth += f.correct + f.missed > 0;
    with_detections += f.correct + f.false_alarms > 0;
  }
  setShares(out.all);
  out.all.ap = share(out.all.ap, with_truth);
  out.mean_precision = share(out.mean_precision, with_detections);
  out.mean_recall = share(out.mean_recall, with_truth);
}

}  // namespace

DetectionErrors evaluateDetections(const std::vector<TrueFrame>& truth,
                                   const std::vector<DetectedFrame>& detections,
                                   const DetectionOptions& options) {
  DetectionErrors out;
  std::vector<std::pair<const TrueFrame*, const DetectedFrame*>> pairs;
  const FramesByTime by_time(truth);
  std::set<int> looked_at;
  std::set<std::string> classes;
  for (const auto& frame : detections) {
    const int index = by_time.nearest(frame.t, options.max_difference_s);
    if (index < 0) continue;
    looked_at.insert(index);
    pairs.emplace_back(&truth[static_cast<std::size_t>(index)], &frame);
    for (const auto& box : pairs.back().first->boxes) classes.insert(box.class_name);
    for (const auto& box : frame.boxes) classes.insert(box.class_name);
  }
  classes.erase(kOther);
  out.frames = static_cast<int>(pairs.size());
  out.frames_without_truth = static_cast<int>(detections.size() - pairs.size());
  out.frames_without_detector = static_cast<int>(truth.size() - looked_at.size());
  for (const auto& name : classes) {
    ClassTally tally;
    for (const auto& [seen, detected] : pairs)
      compareFrame(viewOf(*seen, name, options), ofClass(*detected, name, options.min_score), options, tally);
    out.per_class[name] = figuresOf(tally);
  }
  summarizeClasses(out);
  return out;
}

}  // namespace roomgraph
