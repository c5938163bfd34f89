// SPDX-License-Identifier: BSD-3-Clause
// Sliding window of tracked objects, advanced frame by frame.
#pragma once

#include "object_chain.h"

namespace roomgraph {

/// The objects of the last frames and the latest frame's code.
struct ObjectWindow {
  int frame = 0;  ///< count of the newest frame, from 1
  LabelCodes codes;
  std::vector<ObjectChain> objects;  ///< seen within the window, in order of id
  SemanticCode code;                 ///< of the newest frame
  std::int64_t next_track = 0;
};

/// How the newest frame continues the window.
struct WindowStep {
  double beta = 1;           ///< similarity to the previous frame (Eq. 5); 1 in the first frame
  double beta_star = 1;      ///< similarity to the code of the window
  std::vector<int> objects;  ///< per detection its place in ObjectWindow::objects
};

/// Length of the window and what links objects over it.
struct WindowOptions {
  int frames = 5;            ///< N
  double min_overlap = 0.2;  ///< of a box with the predicted one
  double order_bonus = 0.1;  ///< bonus of a pair of gamma (identityLinks)
  double link_weight = 0.5;  ///< links weigh s (this + 1 - beta); 0: the paper's weight
};

/// Advances the window by a frame: drops sightings that are `frames` or more old, links the frame's sightings
/// (one per detection, with their `labels`) to the objects of the window, and starts new objects for the
/// rest.
WindowStep advance(ObjectWindow& window, std::vector<Sighting> sightings,
                   const std::vector<std::uint8_t>& labels, const Viewpoint& view,
                   const WindowOptions& options);

}  // namespace roomgraph
