// SPDX-License-Identifier: BSD-3-Clause
// A table as aligned text and as CSV.
#pragma once

#include <string>

#include "roomgraph/catalogue/catalogue.h"

namespace roomgraph {

/// Columns aligned with blanks, numbers to the right; a line below the headings.
std::string alignedText(const TextTable& table);

/// RFC 4180, lines ending with a line feed: cells with commas, quotes or line breaks are quoted.
std::string csvText(const TextTable& table);

/// All runs with all their figures, one run a row.
TextTable wideTable(const Catalogue& catalogue);

}  // namespace roomgraph
