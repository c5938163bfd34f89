// SPDX-License-Identifier: BSD-3-Clause
// Objects of a rawlog behind the recovery after broken records.
#include "roomgraph/datasets/rawlog_objects.h"

#include "record_source.h"

namespace roomgraph {

struct RawlogObjects::Impl {
  RecordSource source;
  std::map<std::string, int> skipped{};
};

RawlogObjects::RawlogObjects(const std::filesystem::path& file) : impl_(new Impl{RecordSource(file)}) {}
RawlogObjects::~RawlogObjects() = default;

mrpt::serialization::CSerializable::Ptr RawlogObjects::next() {
  while (const auto item = impl_->source.next()) {
    if (item->object) return item->object;
    ++impl_->skipped[item->reason];
  }
  return nullptr;
}

double RawlogObjects::progress() const {
  return impl_->source.progress();
}
const std::map<std::string, int>& RawlogObjects::skipped() const {
  return impl_->skipped;
}
const std::string& RawlogObjects::truncation() const {
  return impl_->source.truncation();
}

}  // namespace roomgraph
