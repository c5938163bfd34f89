// SPDX-License-Identifier: BSD-3-Clause
// 2D detection: box, class, score, mask and track.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/box.h"

namespace roomgraph {

/// One object seen by the 2D detector (method.md sec. 1.1).
struct Detection {
  Box2 box;                ///< px, inside the image
  std::string class_name;  ///< class of the object database ("swivel_chair", "sofa", "door", "person"), not
                           ///< the network's label
  std::string label;       ///< label as the network or the recording gave it
  double score = 0;        ///< alpha in [0, 1]
  cv::Mat mask;            ///< CV_8UC1 over the box (rows x cols = its rounded size), or empty
  TrackId track;           ///< id from the source when it tracks; may change for the same object
  bool carried = false;    ///< the detector did not run on this frame: features moved the box here
  double rival_score =
      0;  ///< of the best box in the same place whose label is of nothing that is mapped; 0: none
  std::string rival_label;  ///< of that box, where no class of the object database has it
};

}  // namespace roomgraph
