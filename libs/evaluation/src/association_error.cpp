// SPDX-License-Identifier: BSD-3-Clause
// Attribution of measurements to true objects by IoU, majority landmarks, reliability bins.
#include "roomgraph/evaluation/association_error.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace roomgraph {
namespace {

// A measurement and the true object it shows.
struct Attributed {
  const AssociatedBox* measured;
  std::size_t frame;
  int object;
  double overlap;
};

struct Overlap {
  int object = -1;
  double value = 0;
};

Overlap bestObject(const TrueFrame& frame, const AssociatedBox& measured, const AssociationOptions& options) {
  Overlap best;
  for (const auto& truth : frame.boxes) {
    if (truth.class_name != measured.class_name &&
        !isForgiven(options.forgiven_kinds, measured.class_name, truth.class_name, truth.kind))
      continue;
    const double value = iou(truth.box, measured.box);
    if (value >= options.min_iou && value > best.value) best = {truth.id, value};
  }
  return best;
}

std::vector<Attributed> attribute(const std::vector<TrueFrame>& truth,
                                  const std::vector<AssociatedFrame>& associations,
                                  const AssociationOptions& options) {
  std::vector<Attributed> out;
  const FramesByTime by_time(truth);
  for (std::size_t i = 0; i < associations.size(); ++i) {
    const int frame = by_time.nearest(associations[i].t, options.max_difference_s);
    if (frame < 0) continue;
    for (const auto& measured : associations[i].boxes) {
      const Overlap best = bestObject(truth[static_cast<std::size_t>(frame)], measured, options);
      if (best.object >= 0) out.push_back({&measured, i, best.object, best.value});
    }
  }
  return out;
}

std::map<int, int> majorityObjects(const std::vector<Attributed>& list) {
  struct Votes {
    int object, count;
  };
  std::map<int, std::vector<Votes>> votes;  // in the order of the objects' first measurements
  for (const auto& a : list) {
    auto& of_landmark = votes[a.measured->landmark];
    const auto entry = std::find_if(of_landmark.begin(), of_landmark.end(),
                                    [&](const Votes& v) { return v.object == a.object; });
    if (entry == of_landmark.end()) {
      of_landmark.push_back({a.object, 1});
    } else {
      ++entry->count;
    }
  }
  std::map<int, int> out;
  for (const auto& [landmark, of_landmark] : votes)
    out[landmark] =
        std::max_element(of_landmark.begin(), of_landmark.end(), [](const Votes& a, const Votes& b) {
          return a.count < b.count;
        })->object;
  return out;
}

// Compares the decisions frame by frame. An object has a landmark from the frame after the first one of its own.
std::vector<char> judge(const std::vector<Attributed>& list, AssociationErrors& out) {
  std::vector<char> correct(list.size(), 0);
  std::set<int> mapped;
  for (std::size_t begin = 0, end = 0; begin < list.size(); begin = end) {
    while (end < list.size() && list[end].frame == list[begin].frame) ++end;
    std::set<int> mapped_now;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& a = list[i];
      const bool own = out.object_of_landmark.at(a.measured->landmark) == a.object;
      const bool needless = a.measured->is_new && mapped.count(a.object) > 0;
      correct[i] = own && !needless;
      out.needless_new += needless;
      out.wrong_landmark += !own && !needless;
      if (own) mapped_now.insert(a.object);
    }
    mapped.merge(mapped_now);
  }
  return correct;
}

int countSwitches(const std::vector<Attributed>& list) {
  std::map<int, std::map<std::size_t, const Attributed*>> sightings;  // by object and frame
  for (const auto& a : list) {
    const Attributed*& best = sightings[a.object][a.frame];
    if (best == nullptr || a.overlap > best->overlap) best = &a;
  }
  int switches = 0;
  for (const auto& [object, by_frame] : sightings) {
    int landmark = by_frame.begin()->second->measured->landmark;
    for (const auto& [frame, sighting] : by_frame) {
      switches += sighting->measured->landmark != landmark;
      landmark = sighting->measured->landmark;
    }
  }
  return switches;
}

void fillReliability(const std::vector<Attributed>& list, const std::vector<char>& correct,
                     AssociationErrors& out) {
  const auto bins = out.reliability.size();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const double p = list[i].measured->probability;
    if (std::isnan(p)) continue;
    auto& bin = out.reliability[std::min(bins - 1, static_cast<std::size_t>(p * static_cast<double>(bins)))];
    ++bin.count;
    bin.mean_probability += p;
    bin.correct_share += correct[i];
    ++out.with_probability;
  }
  for (auto& bin : out.reliability) {
    if (bin.count == 0) continue;
    bin.mean_probability /= bin.count;
    bin.correct_share /= bin.count;
    out.ece += std::abs(bin.mean_probability - bin.correct_share) * bin.count / out.with_probability;
  }
}

}  // namespace

AssociationErrors evaluateAssociations(const std::vector<TrueFrame>& truth,
                                       const std::vector<AssociatedFrame>& associations,
                                       const AssociationOptions& options) {
  AssociationErrors out;
  const auto list = attribute(truth, associations, options);
  std::size_t measurements = 0;
  for (const auto& frame : associations) measurements += frame.boxes.size();
  out.attributed = static_cast<int>(list.size());
  out.unattributed = static_cast<int>(measurements - list.size());
  out.object_of_landmark = majorityObjects(list);
  std::set<int> objects;
  for (const auto& a : list) objects.insert(a.object);
  out.objects = static_cast<int>(objects.size());
  const auto correct = judge(list, out);
  out.correct = static_cast<int>(std::count(correct.begin(), correct.end(), 1));
  if (out.attributed > 0) out.accuracy = static_cast<double>(out.correct) / out.attributed;
  out.identity_switches = countSwitches(list);
  fillReliability(list, correct, out);
  return out;
}

}  // namespace roomgraph
