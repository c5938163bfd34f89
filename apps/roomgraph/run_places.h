// SPDX-License-Identifier: BSD-3-Clause
// Whether recording and output folder are still there while a run goes on.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "roomgraph/core/output_folder.h"

namespace roomgraph {

/// Looks once a second whether the recording was removed or cut, and whether the output folder was removed:
/// otherwise a run would tell so at its end, or take what is left of the recording for all of it.
class RunPlaces {
 public:
  /// `out` outlives it. Throws InputError: no such recording.
  RunPlaces(std::filesystem::path recording, const OutputFolder& out);

  /// To be called often.
  void look();
  /// Throws RunError naming the place.
  void require() const;

 private:
  std::filesystem::path recording_;
  const OutputFolder& out_;
  std::uintmax_t size_;
  std::chrono::steady_clock::time_point last_look_ = std::chrono::steady_clock::now();
};

}  // namespace roomgraph
