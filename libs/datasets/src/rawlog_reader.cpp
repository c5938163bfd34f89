// SPDX-License-Identifier: BSD-3-Clause
// Objects of a rawlog, converted in file order.
#include "roomgraph/datasets/rawlog_reader.h"

#include "record_source.h"
#include "roomgraph/datasets/record_converter.h"
#include "sensor_choice.h"

namespace roomgraph {

struct RawlogReader::Impl {
  Impl(const std::filesystem::path& file, const ReadOptions& options) : source(file), converter(options, file) {
    checkLabels(file, options);
    if (!options.frames) source.skipClass("CObservation3DRangeScan");
  }

  RecordSource source;
  RecordConverter converter;
  bool source_ended = false;
};

RawlogReader::RawlogReader(const std::filesystem::path& file, const ReadOptions& options)
    : impl_(std::make_unique<Impl>(file, options)) {}
RawlogReader::~RawlogReader() = default;
RawlogReader::RawlogReader(RawlogReader&&) noexcept = default;
RawlogReader& RawlogReader::operator=(RawlogReader&&) noexcept = default;

std::optional<Record> RawlogReader::next() {
  while (true) {
    if (auto record = impl_->converter.next()) return record;
    if (impl_->source_ended) return std::nullopt;
    const auto item = impl_->source.next();
    if (!item) {
      impl_->converter.end(impl_->source.truncation());
      impl_->source_ended = true;
    } else if (item->object) {
      impl_->converter.take(item->object);
    } else {
      impl_->converter.skip(item->reason);
    }
  }
}

double RawlogReader::progress() const {
  return impl_->source.progress();
}
StampJumpsBySensor RawlogReader::stampJumps() const { return impl_->converter.stampJumps(); }

const ReadStatistics& RawlogReader::statistics() const {
  return impl_->converter.statistics();
}

}  // namespace roomgraph
