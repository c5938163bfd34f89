// SPDX-License-Identifier: BSD-3-Clause
// The figures that tables show, with their labels and units.
#pragma once

#include <string>
#include <vector>

namespace roomgraph {

/// A figure worth a row in a table.
struct ShownFigure {
  std::string name;   ///< as in the catalogue
  std::string label;  ///< with its unit
  int decimals = 3;
  int better = 0;  ///< -1: small, 1: large, 0: neither
};

/// In the order of the tables.
const std::vector<ShownFigure>& shownFigures();

/// The entry of this name, or one made of the name alone.
ShownFigure shownFigure(const std::string& name);

}  // namespace roomgraph
