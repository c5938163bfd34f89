// SPDX-License-Identifier: BSD-3-Clause
// Records of rawlogs, for tests of imports.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "roomgraph/datasets/observation_reader.h"

namespace roomgraph::test {

inline const std::string kTinyRoom = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rawlog";

inline std::vector<mrpt::obs::CObservation::Ptr> recordsIn(const std::filesystem::path& rawlog) {
  std::vector<mrpt::obs::CObservation::Ptr> records;
  ObservationReader reader(rawlog);
  while (auto record = reader.next()) records.push_back(std::move(record));
  return records;
}

template <class Class>
std::vector<std::shared_ptr<Class>> only(const std::vector<mrpt::obs::CObservation::Ptr>& records) {
  std::vector<std::shared_ptr<Class>> found;
  for (const auto& record : records)
    if (auto match = std::dynamic_pointer_cast<Class>(record)) found.push_back(match);
  return found;
}

inline double secondsOf(const mrpt::obs::CObservation& record) {
  return mrpt::Clock::toDouble(record.timestamp);
}

}  // namespace roomgraph::test
