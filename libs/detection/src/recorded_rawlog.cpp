// SPDX-License-Identifier: BSD-3-Clause
// Detections out of a rawlog that holds little else.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>

#include "recorded_detector.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {
namespace {

void addRecord(const mrpt::serialization::CSerializable::Ptr& object,
               std::vector<CObservationDetections>& out) {
  const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object);
  if (!observation) return;
  const auto meant = unpacked(observation);
  if (!meant.ok()) throw std::runtime_error(meant.reason());
  if (const auto detections = std::dynamic_pointer_cast<CObservationDetections>(*meant))
    out.push_back(*detections);
}

}  // namespace

std::vector<CObservationDetections> readDetectionRawlog(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) throw InputError(file + ": cannot be read");
  std::vector<CObservationDetections> out;
  try {
    mrpt::io::CFileGZInputStream stream(file);
    auto archive = mrpt::serialization::archiveFrom(stream);
    while (!stream.checkEOF()) addRecord(archive.ReadObject(), out);
  } catch (const mrpt::serialization::CExceptionEOF&) {  // the usual end: gzip does not know it before
  } catch (const std::exception& error) {
    throw InputError(file + ": is no rawlog of detections: " + firstLine(error));
  }
  return out;
}

}  // namespace roomgraph
