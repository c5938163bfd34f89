// SPDX-License-Identifier: BSD-3-Clause
// Records brought into order of time on their way into a rawlog.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <functional>
#include <map>
#include <string>

namespace roomgraph {

/// Holds records back for a few seconds of the recording, so that those that come a little late find their
/// places.
class OrderedRecords {
 public:
  using Sink = std::function<void(const mrpt::obs::CObservation&)>;
  OrderedRecords(double window_s, Sink sink) : window_s_(window_s), sink_(std::move(sink)) {}

  void push(mrpt::obs::CObservation::Ptr record);
  void finish();

  const std::map<std::string, int>& written() const { return written_; }  ///< records by label
  int late() const { return late_; }  ///< records that came after later ones had been written

 private:
  void release(double until);

  double window_s_;
  Sink sink_;
  std::multimap<double, mrpt::obs::CObservation::Ptr> waiting_;  ///< by time, s
  std::map<std::string, int> written_;
  double newest_ = -1e300, last_ = -1e300;
  int late_ = 0;
};

}  // namespace roomgraph
