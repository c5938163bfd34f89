// SPDX-License-Identifier: BSD-3-Clause
// Runs by variant and input, spreads, paired differences, and both as tables.
#include "roomgraph/catalogue/comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <unordered_map>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

/// Where a run stands in the tables.
struct Cell {
  std::size_t variant, input;
};

/// Complete runs of the choice by id.
struct ChosenRuns {
  Comparison head;  ///< without rows
  std::unordered_map<std::int64_t, Cell> cells;
};

void requireKnown(const std::string& what, const std::string& name, const std::set<std::string>& known) {
  if (name.empty() || known.contains(name)) return;
  const std::vector<std::string> names(known.begin(), known.end());
  throw ConfigError("no " + what + " '" + name + "' in the catalogue" + didYouMean(name, names) +
                    "; there are: " + join(names));
}

std::vector<std::string> baselineFirst(const std::set<std::string>& variants, std::string baseline,
                                       const std::string& otherwise) {
  if (baseline.empty()) baseline = variants.contains("default") ? "default" : otherwise;
  std::vector<std::string> out;
  if (!variants.empty()) out.push_back(baseline);
  for (const auto& variant : variants)
    if (variant != baseline) out.push_back(variant);
  return out;
}

ChosenRuns choose(const Catalogue& catalogue, const ComparisonChoice& choice) {
  std::set<std::string> variants, groups, all_groups, revisions;
  std::vector<RunLine> lines;
  std::string first;
  std::int64_t first_id = 0;
  for (auto& line : catalogue.runs()) {
    all_groups.insert(line.group);
    if (line.variant.ends_with(kPieceSuffix) != choice.baseline.ends_with(kPieceSuffix)) continue;  // like with like
    if (line.status != "complete" || (!choice.group.empty() && line.group != choice.group)) continue;
    if (lines.empty() || line.id < first_id) {
      first = line.variant;
      first_id = line.id;
    }
    variants.insert(line.variant);
    groups.insert(line.group);
    revisions.insert(line.revision);
    lines.push_back(std::move(line));
  }
  requireKnown("group of inputs", choice.group, all_groups);
  requireKnown("variant", choice.baseline, variants);
  ChosenRuns out;
  out.head.variants = baselineFirst(variants, choice.baseline, first);
  out.head.groups.assign(groups.begin(), groups.end());
  out.head.revisions.assign(revisions.begin(), revisions.end());
  std::unordered_map<std::string, std::size_t> places, inputs;
  for (const auto& variant : out.head.variants) places.emplace(variant, places.size());
  for (const auto& line : lines)
    out.cells[line.id] = {places.at(line.variant), inputs.emplace(line.input, inputs.size()).first->second};
  out.head.inputs = inputs.size();
  return out;
}

std::optional<PairedDifference> paired(const std::vector<std::optional<double>>& baseline,
                                       const std::vector<std::optional<double>>& variant) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < baseline.size(); ++i)
    if (baseline[i] && variant[i]) differences.push_back(*variant[i] - *baseline[i]);
  if (differences.empty()) return std::nullopt;
  const auto [low, high] = medianInterval(differences);
  const SignedRankTest test = signedRankTest(differences);
  return PairedDifference{differences.size(), spreadOf(differences).median, low, high, test, test.p_value};
}

FigureRow rowOf(const Catalogue& catalogue, const ChosenRuns& chosen, const ShownFigure& figure) {
  const std::size_t variants = chosen.head.variants.size();
  std::vector<std::vector<std::optional<double>>> by_input(
      variants, std::vector<std::optional<double>>(chosen.head.inputs));
  for (const auto& [run, value] : catalogue.figure(figure.name))
    if (const auto cell = chosen.cells.find(run); cell != chosen.cells.end())
      by_input[cell->second.variant][cell->second.input] = value;
  FigureRow row{figure, {}};
  for (std::size_t v = 0; v < variants; ++v) {
    std::vector<double> values;
    for (const auto& value : by_input[v])
      if (value) values.push_back(*value);
    row.variants.push_back({spreadOf(std::move(values)), {}});
    if (v > 0) row.variants.back().difference = paired(by_input[0], by_input[v]);
  }
  return row;
}

// All tests of one table together.
void adjust(std::vector<FigureRow>& rows) {
  std::vector<PairedDifference*> tested;
  std::vector<double> p_values;
  for (auto& row : rows)
    for (auto& variant : row.variants)
      if (variant.difference) {
        tested.push_back(&*variant.difference);
        p_values.push_back(variant.difference->test.p_value);
      }
  const auto adjusted = holmAdjusted(p_values);
  for (std::size_t i = 0; i < tested.size(); ++i) tested[i]->adjusted_p = adjusted[i];
}

// All of fewer values hold the median with less than 95 %: of five with 1 - 2 / 2^5 = 94 %.
constexpr std::size_t kFewestOfInterval = 6;

std::string decimal(double value, int decimals) {
  char text[48];
  if (std::abs(value) < 0.5 * std::pow(10.0, -decimals)) value = 0;  // no "-0.00"
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string pText(double p) {
  return p < 0.0001 ? "< 0.0001" : decimal(p, 4);
}

std::string cellText(const VariantFigure& cell, const ShownFigure& figure, std::size_t most) {
  if (cell.spread.count == 0) return "-";
  const auto number = [&](double value) { return decimal(value, figure.decimals); };
  std::string text = number(cell.spread.median);
  if (cell.spread.count > 1)
    text += " (" + number(cell.spread.first_quartile) + " .. " + number(cell.spread.third_quartile) + ")";
  if (cell.spread.count < most) text = std::to_string(cell.spread.count) + ": " + text;
  return text + (cell.difference && cell.difference->significant() ? " *" : "");
}

}  // namespace

Comparison compareVariants(const Catalogue& catalogue, const ComparisonChoice& choice) {
  const ChosenRuns chosen = choose(catalogue, choice);
  const auto names = catalogue.figureNames();
  const std::set<std::string> known(names.begin(), names.end());
  std::vector<ShownFigure> figures;
  for (const auto& name : choice.figures) {
    requireKnown("figure", name, known);
    figures.push_back(shownFigure(name));
  }
  if (choice.figures.empty())
    std::copy_if(shownFigures().begin(), shownFigures().end(), std::back_inserter(figures),
                 [&known](const ShownFigure& figure) { return known.contains(figure.name); });
  Comparison out = chosen.head;
  for (const auto& figure : figures) out.rows.push_back(rowOf(catalogue, chosen, figure));
  adjust(out.rows);
  return out;
}

TextTable spreadTable(const Comparison& comparison) {
  TextTable table{{"figure"}, {}, {}};
  table.columns.insert(table.columns.end(), comparison.variants.begin(), comparison.variants.end());
  for (const auto& row : comparison.rows) {
    std::vector<std::string> cells{row.figure.label};
    for (const auto& variant : row.variants)
      cells.push_back(cellText(variant, row.figure, comparison.inputs));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

TextTable differenceTable(const Comparison& comparison) {
  TextTable table{
      {"figure", "variant", "pairs", "median difference", "95 % interval", "p", "p (Holm)", "meaning"},
      {},
      {}};
  for (const auto& row : comparison.rows)
    for (std::size_t v = 1; v < row.variants.size(); ++v) {
      if (!row.variants[v].difference) continue;
      const PairedDifference& d = *row.variants[v].difference;
      const auto number = [&](double value) { return decimal(value, row.figure.decimals + 1); };
      const std::string interval =
          d.pairs < kFewestOfInterval ? "-" : number(d.low) + " .. " + number(d.high);
      const double sense = d.median * row.figure.better;
      const std::string meaning = !d.significant() ? ""
                                  : sense > 0      ? "better"
                                  : sense < 0      ? "worse"
                                                   : "differs";
      table.rows.push_back({row.figure.label, comparison.variants[v], std::to_string(d.pairs),
                            number(d.median), interval, pText(d.test.p_value),
                            pText(d.adjusted_p), meaning});
    }
  table.numeric = {false, false, true, true, true, true, true, false};
  return table;
}

}  // namespace roomgraph
