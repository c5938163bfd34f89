// SPDX-License-Identifier: BSD-3-Clause
// Figures of the variants of a batch over inputs and seeds, and their differences from one variant.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/catalogue/catalogue.h"
#include "roomgraph/catalogue/figure_list.h"
#include "roomgraph/catalogue/signed_rank.h"
#include "roomgraph/catalogue/spread.h"

namespace roomgraph {

/// One variant against the baseline, input by input.
struct PairedDifference {
  std::size_t pairs = 0;     ///< inputs that both have
  double median = 0;         ///< of variant minus baseline
  double low = 0, high = 0;  ///< 95 % interval of the median
  SignedRankTest test;
  double adjusted_p =
      1;  ///< p-value corrected for the number of figures and variants that are compared (Holm)

  bool significant() const { return adjusted_p < 0.05; }
};

/// One figure of one variant.
struct VariantFigure {
  Spread spread;
  std::optional<PairedDifference> difference;  ///< nothing: the baseline, or no input in common
};

struct FigureRow {
  ShownFigure figure;
  std::vector<VariantFigure> variants;  ///< as in Comparison::variants
};

/// Tables of a batch.
struct Comparison {
  std::vector<std::string> variants;   ///< the baseline first
  std::vector<std::string> groups;     ///< of the inputs that are in it
  std::vector<std::string> revisions;  ///< of the program, of the runs that are in it
  std::size_t inputs = 0;
  std::vector<FigureRow> rows;
};

/// What to compare.
struct ComparisonChoice {
  std::string baseline;              ///< empty: "default", else the variant of the first run
  std::string group;                 ///< only inputs of it; empty: all
  std::vector<std::string> figures;  ///< empty: the usual ones of shownFigures()
};

/// Over complete runs. Throws ConfigError: no such variant, group or figure (with what was meant).
Comparison compareVariants(const Catalogue& catalogue, const ComparisonChoice& choice);

/// "median (quartile .. quartile)" by variant; beside each difference a * when it is significant.
TextTable spreadTable(const Comparison& comparison);
/// A line for each figure and variant: pairs, median difference with interval, p-values. Without variants to
/// compare: no rows.
TextTable differenceTable(const Comparison& comparison);

}  // namespace roomgraph
