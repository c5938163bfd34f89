// SPDX-License-Identifier: BSD-3-Clause
// Output files of an import, put into place together.
#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/output_file.h"
#include "roomgraph/datasets/truth_file.h"
#include "roomgraph/observations/rawlog_writer.h"

namespace roomgraph {

/// Files of an import to X.rawlog or X.rawlog.gz.
struct ImportPlaces {
  std::filesystem::path rawlog, images, ground_truth;  ///< images: the folder X_Images
};
ImportPlaces placesOf(const std::filesystem::path& rawlog);

/// What the import reads.
struct ImportInputs {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;  ///< in the folder or elsewhere, whether or not they exist
};

/// Throws RunError when the rawlog can have no place, ConfigError when something that is read would be
/// replaced, and when X_Images, to be written, is there and was not made by an import.
void checkPlaces(const ImportPlaces& places, const ImportInputs& inputs, bool external_images);

/// What an import writes: all of it gets into place, or nothing does.
class ImportOutput {
 public:
  /// `external_images`: X_Images is written too. Throws RunError.
  ImportOutput(ImportPlaces places, bool external_images);
  /// Removes what was not put into place.
  ~ImportOutput();

  RawlogWriter& rawlog() { return rawlog_; }
  /// Where to write images; empty when they are in the rawlog.
  const std::filesystem::path& images() const { return new_images_; }
  /// Writes the depth image of a record to the file `name` ("LABEL_STAMP_depth.bin") in images() and lets the
  /// record refer to it. Throws RunError.
  void storeDepth(mrpt::obs::CObservation3DRangeScan& record, const std::string& name) const;
  /// Lines "t x y z qx qy qz qw"; the file begins with whose they are.
  void setGroundTruth(const std::string& text, TruthOf whose);
  /// Puts everything into place; what a former import to the same place left and this one does not have is
  /// removed, unless the import read it. Returns what was removed. Throws RunError.
  std::vector<std::filesystem::path> commit(const ImportInputs& inputs);

 private:
  void swapImages();
  void restoreImages();

  ImportPlaces places_;
  bool replaces_;           ///< there was such a rawlog before
  bool committed_ = false;  ///< the rawlog and its images are in place
  RawlogWriter rawlog_;
  std::filesystem::path pending_, new_images_, old_images_;  ///< the latter two lie in the first
  std::optional<PendingFile> ground_truth_;
};

}  // namespace roomgraph
