// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/datasets/rawlog_copy.h"

#include <mrpt/core/Clock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "image_folder.h"
#include "odometry_sum.h"
#include "plausibility.h"
#include "record_source.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using mrpt::serialization::CSerializable;

constexpr double kAtOnce = -std::numeric_limits<double>::infinity();

double stampOf(const mrpt::obs::CObservation& observation) {
  const auto t = toSeconds(observation.timestamp);
  return t && plausibleTime(*t) ? *t : kAtOnce;
}

// Earliest time of what a record holds; a record without a time goes with the one before it.
double timeOf(const CSerializable::Ptr& object) {
  if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
    return stampOf(*observation);
  const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object);
  double earliest = std::numeric_limits<double>::infinity();
  if (frame)
    for (const auto& observation : *frame)
      if (const double t = stampOf(*observation); t != kAtOnce) earliest = std::min(earliest, t);
  return std::isfinite(earliest) ? earliest : kAtOnce;
}

void linkImages(const fs::path& input, const fs::path& output) {
  const fs::path images = imageFolderOf(input), expected = imageFolderOf(output);
  std::error_code error;
  if (!fs::is_directory(images, error) || fs::equivalent(images, expected, error)) return;
  fs::path name = output;
  if (name.extension() == ".gz") name.replace_extension();
  const fs::path link = fs::absolute(output).parent_path() / (name.stem().string() + "_Images");
  fs::create_directory_symlink(fs::canonical(images), link, error);
  if (error)
    throw RunError(link.string() + ": no link to the external images in " + images.string() + ": " +
                   error.message());
}

}  // namespace

struct RawlogCopy::Impl {
  Impl(const fs::path& input, const fs::path& output) : source(input), name(output.string()) {
    std::error_code error;
    if (fs::equivalent(input, output, error))
      throw RunError(name + ": is the input; give the copy another name");
    file = gzopen(name.c_str(), "wb1");
    if (!file) throw RunError(name + ": cannot be written: " + std::strerror(errno));
    linkImages(input, output);
  }
  ~Impl() {
    if (file) gzclose(file);
  }

  void write(std::string_view bytes) {
    if (!bytes.empty() && gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size())) <= 0)
      throw RunError(name + ": writing failed (disk full?)");
  }
  // The next record that is to be copied, in `waiting`; false at the end of the input.
  bool fill() {
    while (waiting.empty()) {
      const auto item = source.next();
      if (!item) return false;
      if (!item->object || std::dynamic_pointer_cast<CObservationDetections>(item->object)) continue;
      waiting = source.bytesSince(item->offset);
      waiting_t = timeOf(item->object);
    }
    return true;
  }
  void copyUntil(double t) {
    while (fill() && waiting_t < t) {
      write(waiting);
      waiting.clear();
    }
  }

  RecordSource source;
  std::string name;
  gzFile file = nullptr;
  std::string waiting;  ///< a record that was read and not yet written
  double waiting_t = 0;
};

RawlogCopy::RawlogCopy(const fs::path& input, const fs::path& output)
    : impl_(std::make_unique<Impl>(input, output)) {}

RawlogCopy::~RawlogCopy() {
  try {
    finish();
  } catch (const std::exception&) {
    // On the way out of another error, which is the one to be reported.
  }
}

void RawlogCopy::insert(const CObservationDetections& detections) {
  impl_->copyUntil(mrpt::Clock::toDouble(detections.timestamp));
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << detections;
  impl_->write({static_cast<const char*>(stream.getRawBufferData()),
                static_cast<std::size_t>(stream.getTotalBytesCount())});
}

void RawlogCopy::finish() {
  if (!impl_->file) return;
  impl_->copyUntil(std::numeric_limits<double>::infinity());
  const int code = gzclose(impl_->file);
  impl_->file = nullptr;
  if (code != Z_OK) throw RunError(impl_->name + ": writing failed (disk full?)");
}

}  // namespace roomgraph
