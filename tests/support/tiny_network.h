// SPDX-License-Identifier: BSD-3-Clause
// Writer of a minimal Darknet network for the detection tests.
#pragma once

#include <cstdint>
#include <string>

#include "temporary_folder.h"

namespace roomgraph::test {

/// Writes tiny.cfg and tiny.weights: a Darknet network of one convolution, whose weights are all 0 and whose
/// biases say "nothing here", for so many classes. Returns the weights file.
inline std::filesystem::path writeTinyNetwork(const TemporaryFolder& folder, int classes) {
  const int filters = 3 * (classes + 5);
  const std::string count = std::to_string(filters);
  folder.write(
      "tiny.cfg",
      "[net]\nwidth=64\nheight=64\nchannels=3\n\n[convolutional]\nfilters=" + count +
          "\nsize=1\nstride=1\npad=0\nactivation=linear\n\n[yolo]\nmask=0,1,2\nanchors=10,10, 20,20, "
          "30,30\nnum=3\nclasses=" +
          std::to_string(classes) + "\n");
  std::string bytes;
  const auto append = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const std::int32_t version : {0, 2, 0}) append(version);
  append(std::int64_t{0});                             // images seen
  for (int i = 0; i < filters; ++i) append(-20.0f);    // biases
  for (int i = 0; i < 3 * filters; ++i) append(0.0f);  // weights of three channels
  return folder.write("tiny.weights", bytes);
}

}  // namespace roomgraph::test
