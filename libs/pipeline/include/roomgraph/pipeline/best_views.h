// SPDX-License-Identifier: BSD-3-Clause
// BestViews: of each landmark the picture in which it was seen best.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "roomgraph/estimation/object_frames.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// Keeps a JPEG of each landmark's best box while a run goes on. A box is the better the larger it is and the
/// better its proposal fits; carried boxes do not count.
class BestViews : public Sink {
 public:
  void onStep(const StepReport& report) override;
  /// views.jsonl: per landmark `{"id", "timestamp", "bbox", "jpeg"}` with the picture in Base64. `frames`:
  /// what was decided with hindsight; a picture goes to the landmark that its box belongs to in the end.
  std::string text(const ObjectFrames& frames) const;

 private:
  struct View {
    FrameId frame;
    double t = 0;
    Box2 box;
    double rank = 0;
    std::string jpeg;
  };
  std::map<LandmarkId, View> best_;  ///< by the landmark as it was known at the moment
};

}  // namespace roomgraph
