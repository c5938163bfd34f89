// SPDX-License-Identifier: BSD-3-Clause
// Sizes of the recording, place of the output folder.
#include "run_places.h"

#include "roomgraph/core/errors.h"

namespace roomgraph {

RunPlaces::RunPlaces(std::filesystem::path recording, const OutputFolder& out)
    : recording_(std::move(recording)), out_(out) {
  std::error_code error;
  size_ = std::filesystem::file_size(recording_, error);
  if (error) throw InputError(recording_.string() + ": " + error.message());
}

void RunPlaces::look() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_look_ < std::chrono::seconds(1)) return;
  last_look_ = now;
  require();
}

void RunPlaces::require() const {
  out_.requireInPlace();
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(recording_, error);
  if (error) throw RunError(recording_.string() + ": vanished while it was replayed: " + error.message());
  if (size < size_)
    throw RunError(recording_.string() + ": was cut while it was replayed, from " + std::to_string(size_) +
                   " to " + std::to_string(size) + " bytes");
}

}  // namespace roomgraph
