// SPDX-License-Identifier: BSD-3-Clause
// Text tables of numbers with file and line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace roomgraph {

/// One line of a text file of numbers.
struct NumberRow {
  std::string place;  ///< "file:line"
  std::vector<double> values;
};

/// Reads numbers separated by white space or commas; skips empty lines and comments (# or %).
/// Throws InputError for a file that cannot be opened and for anything that is not a finite number.
std::vector<NumberRow> readNumberTable(const std::filesystem::path& file);

}  // namespace roomgraph
