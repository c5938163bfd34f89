// SPDX-License-Identifier: BSD-3-Clause
// A recording read, changed, put into another order and written.
#include "roomgraph/faults/variant.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "lossless_pictures.h"
#include "passing_record.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/datasets/stored_observations.h"
#include "roomgraph/observations/rawlog_writer.h"
#include "variant_records.h"
#include "variant_truth.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation;

bool takesBeams(const VariantOptions& options) {
  return options.every_beam > 1 || std::isfinite(options.field_of_view_rad) || std::isfinite(options.farthest_m);
}

void requireSense(const VariantOptions& options) {
  if (options.every_scan == 1 && options.every_image == 1 && !takesBeams(options) && !options.mirrored && !options.backwards && options.stamps_apart_s == 0)
    throw ConfigError("no change is asked for: the variant would be the recording");
  if (options.every_scan < 1 || options.every_image < 1 || options.every_beam < 1)
    throw ConfigError("of scans, images and beams every first, second, third ... can be kept");
  if (!(options.field_of_view_rad > 0) || !(options.farthest_m > 0) || !(options.stamps_apart_s >= 0))
    throw ConfigError("field of view, farthest range and seconds between stamps must be above 0");
}

std::string bytesOfRecord(const CObservation& observation) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << observation;
  return {static_cast<const char*>(stream.getRawBufferData()), static_cast<std::size_t>(stream.getTotalBytesCount())};
}

CObservation::Ptr recordOf(const std::string& bytes) {
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.data(), bytes.size());
  auto archive = mrpt::serialization::archiveFrom(stream);
  return archive.ReadObject<CObservation>();
}

/// A record that stays in the variant.
struct HeldRecord {
  std::optional<double> t;  ///< as recorded, s; none: it has no stamp
  std::string bytes;
};

std::optional<double> stampOf(const CObservation& observation) {
  if (observation.timestamp == INVALID_TIMESTAMP) return std::nullopt;
  return mrpt::Clock::toDouble(observation.timestamp);
}

/// Which records stay, and what is in them but for their stamps.
class VariantFilter {
 public:
  explicit VariantFilter(const VariantOptions& options) : options_(options) {}

  /// Nothing for what is left out.
  std::optional<HeldRecord> pass(StoredObservation stored) {
    const auto t = stampOf(*stored.observation);
    if (isThinnedOut(*stored.observation, t)) return std::nullopt;
    if (!change(stored)) {
      ++unknown_;
      return std::nullopt;
    }
    if (stored.bytes.empty()) stored.bytes = bytesOfRecord(*stored.observation);
    return HeldRecord{t, std::move(stored.bytes)};
  }
  std::uint32_t imageWidth() const { return image_width_; }
  int unknown() const { return unknown_; }

 private:
  // Detections go with their image.
  bool isThinnedOut(const CObservation& observation, std::optional<double> t) {
    const FaultySensor sensor = sensorOf(observation);
    if (sensor == FaultySensor::kLidar) return scans_++ % options_.every_scan != 0;
    if (sensor != FaultySensor::kCamera) return false;
    const auto* images = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
    if (!images) return t && left_images_.contains(*t);
    image_width_ = images->cameraParams.ncols;
    if (images_++ % options_.every_image == 0) return false;
    if (t) left_images_.insert(*t);
    return true;
  }
  // False: it cannot be told what the record would be. Bytes that are no longer true are removed.
  bool change(StoredObservation& stored) const {
    auto* scan = dynamic_cast<mrpt::obs::CObservation2DRangeScan*>(stored.observation.get());
    if (scan && takesBeams(options_)) {
      thinBeams(*scan, options_);
      stored.bytes.clear();
    }
    if (options_.mirrored) {
      if (!mirror(stored.observation)) return false;
      stored.bytes.clear();
    }
    return !options_.backwards || sensorOf(*stored.observation) != FaultySensor::kOther;
  }

  const VariantOptions& options_;
  int scans_ = 0, images_ = 0, unknown_ = 0;
  std::uint32_t image_width_ = 0;
  std::set<double> left_images_;
};

/// Records of one stamp that follow one another.
using Instant = std::vector<HeldRecord>;

std::vector<Instant> instantsOf(std::vector<HeldRecord> records) {
  std::vector<Instant> out;
  for (auto& record : records) {
    if (out.empty() || !record.t || out.back().front().t != record.t) out.emplace_back();
    out.back().push_back(std::move(record));
  }
  return out;
}

VariantTime timeOf(const std::vector<Instant>& instants, const VariantOptions& options) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const auto& instant : instants)
    if (const auto t = instant.front().t) {
      first = std::min(first, *t);
      last = std::max(last, *t);
    }
  if (options.stamps_apart_s == 0) return {first, last, options.backwards};
  const double apart = options.stamps_apart_s;
  VariantTime time(first, first + apart * static_cast<double>(instants.size() - 1), options.backwards);
  for (std::size_t i = 0; i < instants.size(); ++i)
    if (const auto t = instants[i].front().t) time.move(*t, first + apart * static_cast<double>(i));
  return time;
}

void writeRecord(RawlogWriter& writer, const HeldRecord& record, const VariantTime& time, const VariantOptions& options) {
  double t = record.t.value_or(0);
  if (record.t) time.map(t);
  if (!options.backwards && (!record.t || t == *record.t)) return writer.write(record.bytes);
  const auto observation = recordOf(record.bytes);
  if (record.t) observation->timestamp = mrpt::Clock::fromDouble(t);
  if (options.backwards) reverseMotion(*observation);
  writer.write(*observation);
}

void requireOthers(const std::filesystem::path& input, const std::filesystem::path& output,
                   const std::vector<VariantTruth>& truths) {
  std::vector<std::filesystem::path> inputs{input};
  for (const auto& truth : truths) inputs.push_back(truth.input);
  requireOther(output, inputs);
  for (const auto& truth : truths) requireOther(truth.output, inputs);
}

}  // namespace

VariantResult writeVariant(const std::filesystem::path& input, const std::filesystem::path& output,
                           const VariantOptions& options, const std::vector<VariantTruth>& truths,
                           const std::function<void(double share)>& progress) {
  requireSense(options);
  requireOthers(input, output, truths);
  const LosslessPictures lossless;
  StoredObservationReader reader(input);
  RawlogWriter writer(output);
  VariantResult result;
  VariantFilter filter(options);
  std::vector<HeldRecord> records;
  while (auto stored = reader.next()) {
    ++result.read;
    if (auto held = filter.pass(std::move(*stored))) records.push_back(std::move(*held));
    if (progress) progress(0.5 * reader.progress());
  }
  if (records.empty()) throw ConfigError("no record stays: " + output.string() + " was not written");
  auto instants = instantsOf(std::move(records));
  const VariantTime time = timeOf(instants, options);
  std::vector<std::string> texts;
  for (const auto& truth : truths) texts.push_back(variantOfTruth(truth, time, options, filter.imageWidth()));
  if (options.backwards) std::reverse(instants.begin(), instants.end());
  for (std::size_t i = 0; i < instants.size(); ++i) {
    for (const auto& record : instants[i]) writeRecord(writer, record, time, options);
    result.written += static_cast<int>(instants[i].size());
    if (progress) progress(0.5 + 0.5 * static_cast<double>(i + 1) / static_cast<double>(instants.size()));
  }
  result.skipped = reader.skipped();
  if (filter.unknown()) result.skipped["of a kind that cannot be mirrored or reversed"] = filter.unknown();
  result.truncation = reader.truncation();
  writer.finish();
  for (std::size_t i = 0; i < truths.size(); ++i) writeFileAtomically(truths[i].output, texts[i]);
  return result;
}

}  // namespace roomgraph
