// SPDX-License-Identifier: BSD-3-Clause
// Sink that records the detections of a run into a copy of its rawlog.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "roomgraph/datasets/rawlog_copy.h"
#include "roomgraph/detection/detector.h"
#include "roomgraph/observations/rawlog_writer.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// Writes a copy of the input that also holds what the detector finds (docs/formats.md). Boxes that were only
/// carried are not written: the replay carries them again.
class DetectionRecording : public Sink {
 public:
  /// The detector outlives the recording. `time_offsets_s`: by sensor label, what was added to the stamps of the input when it was read;
  /// the copy has the stamps of the input. Throws like RawlogCopy.
  DetectionRecording(const std::filesystem::path& input, const std::filesystem::path& output,
                     const Detector& detector, std::map<std::string, double> time_offsets_s = {})
      : copy_(input, output), detector_(detector), time_offsets_s_(std::move(time_offsets_s)) {}

  void onStep(const StepReport& report) override;
  /// Copies the rest of the input. Throws RunError when writing failed.
  void finish() { copy_.finish(); }

 private:
  RawlogCopy copy_;
  const Detector& detector_;
  std::map<std::string, double> time_offsets_s_;
};

/// Writes what the detector finds, and nothing else, as a rawlog that `[detection] file` takes: a thousandth
/// of a recording's size. It gets its name by finish().
class DetectionFile : public Sink {
 public:
  /// The detector outlives the file. Throws RunError: cannot be written.
  DetectionFile(const std::filesystem::path& output, const Detector& detector)
      : writer_(output), detector_(detector) {}

  void onStep(const StepReport& report) override;
  /// Throws RunError when writing failed.
  void finish() { writer_.finish(); }

 private:
  RawlogWriter writer_;
  const Detector& detector_;
};

}  // namespace roomgraph
