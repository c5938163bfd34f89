// SPDX-License-Identifier: BSD-3-Clause
// Formatting of findings and their order by severity.
#include "findings.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace roomgraph {

std::string format(const char* pattern, ...) {
  char text[400];
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(text, sizeof text, pattern, values);
  va_end(values);
  return text;
}

std::vector<Finding> Findings::sorted() {
  std::stable_sort(list_.begin(), list_.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return std::move(list_);
}

std::string nameOf(const SensorReport& sensor) {
  return sensor.label.empty() ? sensor.class_name : sensor.label;
}

}  // namespace roomgraph
