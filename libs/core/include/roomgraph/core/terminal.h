// SPDX-License-Identifier: BSD-3-Clause
// Width of the terminal that people look at.
#pragma once

#include <cstddef>

namespace roomgraph {

/// Columns of the terminal behind a descriptor, at least one; 80 where there is no terminal or it does not
/// say. A line of so many characters would already go on in the next row.
std::size_t terminalWidth(int descriptor);

}  // namespace roomgraph
