// SPDX-License-Identifier: BSD-3-Clause
// CLI11 validators for finite numbers with a lower bound.
#include <cmath>
#include <cstdlib>

#include "commands.h"

namespace roomgraph {
namespace {

// What CLI11 has for this purpose answers with its largest number, all 309 digits.
CLI::Validator numberCheck(bool (*allowed)(double), const std::string& rule, const std::string& name) {
  return CLI::Validator(
      [=](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool good = !text.empty() && *end == '\0' && std::isfinite(value) && allowed(value);
        return good ? "" : "'" + text + "' is not allowed: must be " + rule;
      },
      name);
}

}  // namespace

CLI::Validator atLeastZero() {
  return numberCheck([](double value) { return value >= 0; }, "a number, 0 or more", ">= 0");
}

CLI::Validator aboveZero() {
  return numberCheck([](double value) { return value > 0; }, "a number above 0", "> 0");
}

}  // namespace roomgraph
