// SPDX-License-Identifier: BSD-3-Clause
// Sequences of proposals with known truth in which a frame alone misleads, and what a selector makes of them.
#pragma once

#include <string>
#include <vector>

#include "made_up_room.h"

namespace roomgraph::test {

/// One frame of a scene. The source of a right proposal is "right", that of any other "rival".
struct SceneFrame {
  FrameContext context;
  FrameProposals proposals;
  std::vector<int> objects;  ///< per detection the object it shows; -1: none, a false alarm
};

/// A sequence of frames, made from a seed.
using Scene = std::vector<SceneFrame>;

/// An occluder passes before a chair: for 2 to 4 of 12 frames it hides the lower side and a part of the
/// features, and a proposal at the occluder's depth fits the rest as well, with a better score.
Scene occluderEnters(unsigned seed);
/// The same occluder stands there from the beginning and leaves after 3 to 5 frames: the frames before are
/// wrong.
Scene occluderLeaves(unsigned seed);
/// The detector misses one of two sofas in a fifth of the frames, and in a third it boxes only one half,
/// which a sofa turned by a quarter fits better than the true one.
Scene boxFlickers(unsigned seed);
/// A table hides the lower part of a chair: in every frame two depths fit, with scores that change at random.
Scene twoDepthsCompete(unsigned seed);
/// The robot drives round two chairs, which change their order in the image. While one hides a part of the
/// other, the hidden one has a rival at the depth of the nearer one.
Scene chairsChangeOrder(unsigned seed);
/// A chair of which two depths fit is pushed aside by a metre: consistency with the frames before is wrong.
Scene chairIsMoved(unsigned seed);
/// A chair that the detector is never sure of, beside false alarms that last one to three frames, each as
/// good as the chair.
Scene weakObject(unsigned seed);
/// Four chairs in a row; in a fifth of the frames the estimated yaw is wrong by up to half their distance.
Scene jerkyRow(unsigned seed);

/// Counts over one or more scenes.
struct SceneCounts {
  int detections = 0;         ///< of objects, with a right proposal among their proposals
  int right = 0, wrong = 0;   ///< of these: with the right proposal selected, with another one
  int links = 0, kept = 0;    ///< selected measurements of an object seen before; in its former track
  int false_alarms = 0;       ///< detections that show nothing
  int false_selected = 0;     ///< of these: with a selected proposal
  double squared_errors = 0;  ///< of the confidences against right (1) or wrong (0)
  double rightShare() const { return ratio(right, detections); }
  double wrongShare() const { return ratio(wrong, detections); }
  double brierScore() const { return right + wrong > 0 ? squared_errors / (right + wrong) : 0; }
  double identityShare() const { return ratio(kept, links); }
  double falseShare() const { return ratio(false_selected, false_alarms); }

 private:
  static double ratio(int part, int whole) { return whole > 0 ? static_cast<double>(part) / whole : 0; }
};

/// A selector of this class with lines "key = value" of its section, over the scenes of seeds first_seed, …
SceneCounts countOver(Scene (*scene)(unsigned), const std::string& selector, const std::string& keys,
                      unsigned first_seed, unsigned seeds);

}  // namespace roomgraph::test
