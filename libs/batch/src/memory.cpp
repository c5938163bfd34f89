// SPDX-License-Identifier: BSD-3-Clause
// /proc/meminfo and control groups; forecast by likeness.
#include "memory.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace roomgraph {
namespace {

constexpr double kMargin = 1.25;
// Of a run of which nothing is known: the program itself, and its maps and views growing with the recording.
constexpr double kBase_mb = 400, kShareOfInput = 0.25;

double meminfo(const std::string& key) {
  std::ifstream in("/proc/meminfo");
  std::string name, unit;
  double kib = 0;
  while (in >> name >> kib && std::getline(in, unit))
    if (name == key + ":") return kib * 1024 / 1e6;
  return std::numeric_limits<double>::infinity();
}

// Copies of files, which the kernel gives up for programs.
double bytesOfFiles(const std::filesystem::path& group) {
  std::ifstream in(group / "memory.stat");
  double sum = 0, bytes = 0;
  for (std::string name; in >> name >> bytes;)
    if (name == "active_file" || name == "inactive_file") sum += bytes;
  return sum;
}

}  // namespace

double controlGroupRoom(const std::filesystem::path& group) {
  double most = 0, used = 0;
  if (!(std::ifstream(group / "memory.max") >> most) || !(std::ifstream(group / "memory.current") >> used))
    return std::numeric_limits<double>::infinity();
  return (most - used + bytesOfFiles(group)) / 1e6;
}

double availableMemory() { return std::min(meminfo("MemAvailable"), controlGroupRoom("/sys/fs/cgroup")); }

double MemoryForecast::expected(const std::string& sha256, std::int64_t bytes) const {
  const double size = std::max(1.0, static_cast<double>(bytes));
  double nearest = std::numeric_limits<double>::infinity(), peak = kBase_mb + kShareOfInput * size / 1e6;
  for (const auto& cost : past_) {
    if (cost.sha256 == sha256) return kMargin * cost.peak_memory_mb;
    const double ratio = size / std::max(1.0, static_cast<double>(cost.bytes));
    if (const double distance = std::abs(std::log(ratio)); distance < nearest) {
      nearest = distance;
      peak = cost.peak_memory_mb * std::max(1.0, ratio);
    }
  }
  return kMargin * peak;
}

void MemoryForecast::add(const PastCost& cost) {
  for (auto& known : past_)
    if (known.sha256 == cost.sha256) {
      known.peak_memory_mb = std::max(known.peak_memory_mb, cost.peak_memory_mb);
      return;
    }
  past_.push_back(cost);
}

}  // namespace roomgraph
