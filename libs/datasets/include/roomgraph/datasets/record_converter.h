// SPDX-License-Identifier: BSD-3-Clause
// RecordConverter: records of a run from MRPT's actions, sensory frames and observations.
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "roomgraph/datasets/rawlog_reader.h"

namespace roomgraph {

/// Converts MRPT's objects into records: what RawlogReader does with the objects of its file, for whoever is
/// given them one by one. Objects that cannot be used are skipped and counted, never fatal. A record may come
/// out later than its object went in, because a time stamp is judged by the next one of its sensor.
class RecordConverter {
 public:
  /// `recording`: the file beside which external images are; empty: there are none. That the labels asked for
  /// occur is not checked.
  explicit RecordConverter(const ReadOptions& options = {}, const std::filesystem::path& recording = {});
  ~RecordConverter();
  RecordConverter(RecordConverter&&) noexcept;
  RecordConverter& operator=(RecordConverter&&) noexcept;

  /// An action collection, a sensory frame or an observation; anything else is counted as not used.
  /// Observations get the place of ReadOptions::sensor_poses.
  void take(const mrpt::serialization::CSerializable::Ptr& object);
  /// Counts what could not even become an object.
  void skip(const std::string& reason);
  /// No more objects will come. `warning`: why, if they should.
  void end(const std::string& warning = "");
  /// The next usable record; nothing: there is none before more objects are taken.
  std::optional<Record> next();
  const ReadStatistics& statistics() const;
  /// Of the records that were given; on any thread.
  StampJumpsBySensor stampJumps() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
