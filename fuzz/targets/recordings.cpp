// SPDX-License-Identifier: BSD-3-Clause
// Rawlogs, plain or gzipped, through each of their readers; folders of TUM.
#include <mrpt/obs/CObservation3DRangeScan.h>

#include "../target.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/detection_records.h"
#include "roomgraph/datasets/observation_reader.h"
#include "roomgraph/datasets/rawlog_copy.h"
#include "roomgraph/datasets/rawlog_peek.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/datasets/stored_observations.h"
#include "roomgraph/datasets/tum_import.h"
#include "three_frames.h"

namespace roomgraph::fuzz {
namespace {

void readAllRecords(const std::filesystem::path& file) {
  RawlogReader reader(file);
  while (const auto record = reader.next()) require(test::isFinite(*record), "records are finite");
  reader.statistics();
}

ROOMGRAPH_FUZZ_TARGET(rawlog) {
  readAllRecords(scratchFile("x.rawlog", bytes));
}

ROOMGRAPH_FUZZ_TARGET(rawlog_info) {
  const auto file = scratchFile("x.rawlog", bytes);
  peekRawlog(file);
  const auto report = inspectRawlog(file);
  findProblems(report);
}

ROOMGRAPH_FUZZ_TARGET(rawlog_copy) {
  const auto file = scratchFile("x.rawlog", bytes);
  RawlogCopy copy(file, scratchFolder() / "copy.rawlog");
  copy.insert(*test::makeDetections(1000.15));
  copy.finish();
  exportDetectionRecords(file, scratchFolder() / "records.rawlog");
}

ROOMGRAPH_FUZZ_TARGET(rawlog_observations) {
  const auto file = scratchFile("x.rawlog", bytes);
  ObservationReader observations(file);
  while (const auto observation = observations.next())
    if (const auto images = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation))
      observations.frameOf(*images);
  StoredObservationReader stored(file);
  while (stored.next()) continue;
}

// A sound recording whose images in files are the input: colour, then depth.
ROOMGRAPH_FUZZ_TARGET(rawlog_images) {
  static const auto file = [] {
    std::filesystem::create_directory(scratchFolder() / "outside_Images");
    std::string recording;
    for (const double t : {1000.0, 1000.1}) {
      const auto images = test::makeImages(t);
      const auto folder = (scratchFolder() / "outside_Images").string() + "/";
      images->rangeImage_convertToExternalStorage("depth.bin", folder);
      images->intensityImage.setExternalStorage("color.jpg");
      recording += test::bytesOf(images);
    }
    return scratchFile("outside.rawlog", recording);
  }();
  writeParts(bytes, {"outside_Images/color.jpg", "outside_Images/depth.bin"});
  readAllRecords(file);
}

ROOMGRAPH_FUZZ_TARGET(tum) {
  const auto folder = scratchFolder() / "tum";
  std::filesystem::create_directory(folder);
  writeParts(bytes, {"tum/camera.json", "tum/associations.txt", "tum/groundtruth.txt", "tum/color.png",
                     "tum/depth.png"});
  importTum(folder, scratchFolder() / "tum.rawlog");
}

ROOMGRAPH_FUZZ_TARGET(tum_lists) {
  const auto folder = scratchFolder() / "tum_lists";
  std::filesystem::create_directory(folder);
  writeParts(bytes, {"tum_lists/camera.json", "tum_lists/rgb.txt", "tum_lists/depth.txt",
                     "tum_lists/groundtruth.txt", "tum_lists/color.jpg", "tum_lists/depth.png"});
  importTum(folder, scratchFolder() / "tum.rawlog", {.external_images = true});
}

}  // namespace
}  // namespace roomgraph::fuzz
