// SPDX-License-Identifier: BSD-3-Clause
// LostSpans: when camera and lidar gave no movement, or no data.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// A span of a run without help from one sensor.
struct LostSpan {
  std::string sensor;       ///< "camera" or "lidar"
  double from = 0, to = 0;  ///< s: the first record concerned, the first after it that was good again
  int records = 0;          ///< that told nothing; 0: there were none
  std::string why;          ///< "too few matches", …; "no record"
};

/// Notes of every frame and scan whether it could be used while a run goes on.
class LostSpans : public Sink {
 public:
  void onStep(const StepReport& report) override;
  /// In order of time: records in a row that were lost for one reason, and gaps between records (also to the
  /// beginning and the end of the run) that are longer than a second and than ten usual spacings. A sensor
  /// that never had a record has none.
  std::vector<LostSpan> spans() const;
  /// lost.jsonl: a span per line, `{"sensor", "from", "to", "records", "why"}`.
  std::string text() const;

 private:
  struct Seen {
    double t = 0;
    std::string why;  ///< empty: it could be used
  };
  std::map<std::string, std::vector<Seen>> seen_;  ///< by sensor
  double first_t_ = 0, last_t_ = 0;
  bool begun_ = false;
};

}  // namespace roomgraph
