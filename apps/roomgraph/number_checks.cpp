// SPDX-License-Identifier: BSD-3-Clause
// CLI11 validators for finite numbers with a lower bound; sizes of pictures.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "commands.h"
#include "roomgraph/core/errors.h"

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

std::pair<int, int> sizeInPixels(const std::string& text) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 64 || height < 64 ||
      width > 8192 || height > 8192)
    throw ConfigError("--size " + text + ": give WIDTHxHEIGHT in pixels, 64 to 8192, as in 1280x960");
  return {width, height};
}

}  // namespace roomgraph
