// SPDX-License-Identifier: BSD-3-Clause
// One pass over the input through the chain of faults into the output.
#include "roomgraph/faults/damage.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

#include "fault_kinds.h"
#include "lossless_pictures.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/datasets/stored_observations.h"
#include "roomgraph/observations/rawlog_writer.h"

namespace roomgraph {
namespace {

using Faults = std::vector<std::unique_ptr<Fault>>;

/// Gives records their time since the first stamp.
class RecordingClock {
 public:
  double secondsOf(const mrpt::obs::CObservation& observation) {
    if (observation.timestamp == INVALID_TIMESTAMP) return std::numeric_limits<double>::quiet_NaN();
    const double t = mrpt::Clock::toDouble(observation.timestamp);
    if (!begun_) start_ = t;
    begun_ = true;
    latest_ = std::max(latest_, t - start_);
    return t - start_;
  }
  double latest() const { return latest_; }

 private:
  double start_ = 0, latest_ = 0;
  bool begun_ = false;
};

/// The faults one behind the other, and the output behind the last.
class FaultChain {
 public:
  FaultChain(const std::vector<FaultRequest>& requests, std::uint64_t seed) {
    for (const auto& request : requests) faults_.push_back(makeFault(request, Random(seed, faults_.size())));
  }

  PassingRecords pass(PassingRecord record) {
    PassingRecords records;
    records.push_back(std::move(record));
    return throughFrom(0, std::move(records));
  }
  /// What each held back goes through those behind it.
  PassingRecords finish() {
    PassingRecords out;
    for (std::size_t i = 0; i < faults_.size(); ++i)
      for (auto& record : throughFrom(i + 1, faults_[i]->finish())) out.push_back(std::move(record));
    return out;
  }
  const Faults& faults() const { return faults_; }

 private:
  PassingRecords throughFrom(std::size_t first, PassingRecords records) {
    for (std::size_t i = first; i < faults_.size(); ++i) {
      PassingRecords next;
      for (auto& record : records)
        for (auto& left : faults_[i]->pass(std::move(record))) next.push_back(std::move(left));
      records = std::move(next);
    }
    return records;
  }

  Faults faults_;
};

int writeAll(RawlogWriter& writer, const PassingRecords& records) {
  for (const auto& record : records) {
    if (record.bytes.empty())
      writer.write(*record.observation);
    else
      writer.write(record.bytes);
  }
  return static_cast<int>(records.size());
}

void collectEffects(const std::vector<FaultRequest>& requests, const Faults& faults, DamageResult& result) {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const std::string name = "--" + requests[i].kind + " " + requests[i].value;
    if (faults[i]->counts().empty()) {
      char span[40];
      std::snprintf(span, sizeof span, "%.2f", result.duration_s);
      const std::string needs = faults[i]->needs();
      throw ConfigError(name + ": touches no record; " + (needs.empty() ? "" : "it needs " + needs + ", and ") + "the recording lasts " + span + " s");
    }
    result.effects.push_back({name, faults[i]->counts()});
  }
}

}  // namespace

DamageResult damageRawlog(const std::filesystem::path& input, const std::filesystem::path& output,
                          const std::vector<FaultRequest>& requests, std::uint64_t seed,
                          const std::function<void(double share)>& progress) {
  if (requests.empty()) throw ConfigError("no fault is asked for");
  FaultChain chain(requests, seed);
  StoredObservationReader reader(input);
  requireOther(output, {input});
  RawlogWriter writer(output);
  const LosslessPictures lossless;
  DamageResult result;
  RecordingClock clock;
  while (auto stored = reader.next()) {
    ++result.read;
    const double t = clock.secondsOf(*stored->observation);
    const FaultySensor sensor = sensorOf(*stored->observation);
    const auto records = chain.pass({t, sensor, stored->observation, std::move(stored->bytes)});
    result.written += writeAll(writer, records);
    if (progress) progress(reader.progress());
  }
  result.written += writeAll(writer, chain.finish());
  result.duration_s = clock.latest();
  result.skipped = reader.skipped();
  result.truncation = reader.truncation();
  collectEffects(requests, chain.faults(), result);
  if (result.written == 0)
    throw ConfigError("the faults leave no record: " + output.string() + " was not written");
  writer.finish();
  return result;
}

}  // namespace roomgraph
