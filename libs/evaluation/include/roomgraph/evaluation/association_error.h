// SPDX-License-Identifier: BSD-3-Clause
// Accuracy, identity switches and calibration of data association against truth.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "roomgraph/evaluation/forgiven_kinds.h"
#include "roomgraph/evaluation/frame_files.h"

namespace roomgraph {

struct AssociationOptions {
  double min_iou = 0.3;            ///< of a measurement and the true box it is attributed to
  double max_difference_s = 0.02;  ///< largest difference of the stamps of a frame
  ForgivenKinds forgiven_kinds = forgivenChairs();
};

/// Decisions whose probability lies in one tenth of [0, 1].
struct ReliabilityBin {
  int count = 0;
  double mean_probability = 0, correct_share = 0;  ///< 0 without decisions
};

struct AssociationErrors {
  int attributed = 0;    ///< measurements of a true object
  int unattributed = 0;  ///< measurements of nothing, or in a frame without truth
  int correct = 0;       ///< decisions
  int needless_new = 0;  ///< wrong decisions: a new landmark for an object that had one
  int wrong_landmark = 0;
  int objects = 0;            ///< true objects with measurements; object_of_landmark has their landmarks
  double accuracy = 0;        ///< correct / attributed; 0 without any
  int identity_switches = 0;  ///< consecutive sightings of one true object that went to different landmarks
  std::array<ReliabilityBin, 10> reliability;
  int with_probability = 0;  ///< decisions in the bins
  double ece = 0;            ///< expected calibration error: mean gap of the bins, weighted by count
  std::map<int, int> object_of_landmark;  ///< id of the landmark -> id of the true object
};

/// Compares every decision of the data association with the truth. A measurement belongs to the true object of its
/// class (or of a forgiven kind) whose box has the highest IoU with it; a landmark to the object of most of its
/// measurements (of equals: the first). An existing landmark is the right decision when it belongs to the object of the
/// measurement; a new one when, moreover, the object had no landmark of its own after the earlier frames. Of several
/// measurements of an object in a frame, the one with the highest IoU is the sighting.
AssociationErrors evaluateAssociations(const std::vector<TrueFrame>& truth,
                                       const std::vector<AssociatedFrame>& associations,
                                       const AssociationOptions& options = {});

}  // namespace roomgraph
