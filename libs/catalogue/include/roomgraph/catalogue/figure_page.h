// SPDX-License-Identifier: BSD-3-Clause
// One HTML page about all runs of a batch.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/catalogue/comparison.h"

namespace roomgraph {

/// Where the page's links lead.
struct PagePlaces {
  std::string title;
  std::filesystem::path runs;  ///< folder of the runs
  std::string link;            ///< what it is called from where the page lies ("runs")
};

/// A page that loads nothing and needs no script: figures by variant over all inputs and by group of inputs,
/// differences from the baseline, what failed and why, and all runs with links to those reports that are
/// there (the first 2000 runs). Throws like compareVariants().
std::string batchPage(const Catalogue& catalogue, const ComparisonChoice& choice, const PagePlaces& places);

}  // namespace roomgraph
