// SPDX-License-Identifier: BSD-3-Clause
// Portable random numbers in independent streams of one seed.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace roomgraph {

/// Random numbers that are the same with every standard library (std::normal_distribution is not).
class Random {
 public:
  /// Independent streams of one seed: `stream` names the consumer, `index` the frame.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0, std::uint64_t index = 0)
      : engine_(mixed(mixed(mixed(seed) + stream) + index)) {}

  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }  ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }
  /// Standard normal deviate (Box and Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  double normal(double mean, double sigma) { return mean + sigma * normal(); }

 private:
  /// Bit mixer (splitmix64, Steele et al. 2014): neighbouring seeds give unrelated streams.
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }
  std::mt19937_64 engine_;
};

}  // namespace roomgraph
