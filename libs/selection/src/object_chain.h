// SPDX-License-Identifier: BSD-3-Clause
// Sightings of one object over the window and their pairwise energies.
#pragma once

#include <deque>

#include "crf.h"
#include "potentials.h"
#include "semantic_code.h"

namespace roomgraph {

/// One sighting of an object: the parts of a detection and its proposals that later frames need.
struct Sighting {
  int frame = 0;  ///< count of the frame, set when it enters the window
  Box2 box;       ///< of the detection, px
  Viewpoint view;
  std::vector<ShapeInWorld> shapes;    ///< of the proposals 1..P
  std::vector<double> unary;           ///< per state (crf.h): 0, then the proposals' energies
  std::vector<std::int64_t> features;  ///< inside the box, ascending
  Eigen::MatrixXd pairwise;            ///< energy with the states of the sighting before; empty: first
};

/// An object followed over the window.
struct ObjectChain {
  TrackId id;
  std::uint8_t label = 0;
  int born = 0;                    ///< count of the frame of the first sighting
  std::deque<Sighting> sightings;  ///< those inside the window, oldest first; never empty
};

/// `proposals`: those of this detection.
Sighting makeSighting(const Detection& detection, const std::vector<const Proposal*>& proposals,
                      const Viewpoint& view, const std::vector<FeatureTrack>& features);

/// Pairwise energies w P between the states of two sightings, w = s (c + 1 - beta) (Eq. 3, 6). The state
/// "none" has no area: after a proposal its overlap is 0 and it costs w (unless the sighting has no
/// proposals); before a proposal, or before another "none", it costs nothing. So a bad link, whose P is at
/// most 1, never makes "none" cheaper than a proposal in the newest frame, and an earlier sighting without
/// proposals adds no cost to a proposal now.
Eigen::MatrixXd pairwiseEnergies(const Sighting& before, const Sighting& now, double weight);

/// Predicted box of the detection in another view, cut by the image border: moved and scaled like the
/// projection of the sighting's best shape; without proposals, moved by the camera's rotation alone. Nothing
/// when outside.
std::optional<Box2> predictedBox(const Sighting& sighting, const Viewpoint& view);

/// The chain of one object over its sightings (frames without one are left out: their only state is "none").
/// `none`: energy of not selecting any proposal of a frame.
ChainProblem chainProblem(const ObjectChain& chain, bool must_appear, double none);

}  // namespace roomgraph
