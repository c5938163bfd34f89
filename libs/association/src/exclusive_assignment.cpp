// SPDX-License-Identifier: BSD-3-Clause
// Dynamic programming over subsets per connected component of the assignment graph.
#include "exclusive_assignment.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

constexpr std::size_t kMaxExact = 12;
constexpr double kMaxRatio = 1e17, kMinRatio = 1e-17;  // twelve of them multiply without overflow

// Measurements and landmarks that compete with each other.
struct Component {
  std::vector<Eigen::Index> rows, columns;
};

// Connected component of a row in the graph of positive ratios.
Component reachable(const Eigen::MatrixXd& ratios, Eigen::Index first, std::vector<char>& row_done) {
  Component out;
  std::vector<char> column_done(static_cast<std::size_t>(ratios.cols()), 0);
  out.rows.push_back(first);
  row_done[static_cast<std::size_t>(first)] = 1;
  for (std::size_t next = 0; next < out.rows.size(); ++next) {
    for (Eigen::Index j = 0; j < ratios.cols(); ++j) {
      if (ratios(out.rows[next], j) <= 0 || column_done[static_cast<std::size_t>(j)]) continue;
      column_done[static_cast<std::size_t>(j)] = 1;
      out.columns.push_back(j);
      for (Eigen::Index k = 0; k < ratios.rows(); ++k) {
        if (ratios(k, j) <= 0 || row_done[static_cast<std::size_t>(k)]) continue;
        row_done[static_cast<std::size_t>(k)] = 1;
        out.rows.push_back(k);
      }
    }
  }
  std::sort(out.rows.begin(), out.rows.end());
  std::sort(out.columns.begin(), out.columns.end());
  return out;
}

std::vector<Component> componentsOf(const Eigen::MatrixXd& ratios) {
  std::vector<Component> out;
  std::vector<char> row_done(static_cast<std::size_t>(ratios.rows()), 0);
  for (Eigen::Index k = 0; k < ratios.rows(); ++k)
    if (!row_done[static_cast<std::size_t>(k)]) out.push_back(reachable(ratios, k, row_done));
  return out;
}

// Zeroes the weakest link of every component that is too large; false when there is none.
bool cutWeakest(Eigen::MatrixXd& ratios) {
  bool cut = false;
  for (const auto& component : componentsOf(ratios)) {
    if (std::min(component.rows.size(), component.columns.size()) <= kMaxExact) continue;
    double* weakest = nullptr;
    for (const auto k : component.rows)
      for (const auto j : component.columns)
        if (ratios(k, j) > 0 && (!weakest || ratios(k, j) < *weakest)) weakest = &ratios(k, j);
    *weakest = 0;
    cut = true;
  }
  return cut;
}

// Columns that a row may take, as most could not: in order, for each row.
std::vector<std::vector<Eigen::Index>> linksOf(const Eigen::MatrixXd& w) {
  std::vector<std::vector<Eigen::Index>> out(static_cast<std::size_t>(w.rows()));
  for (Eigen::Index r = 0; r < w.rows(); ++r)
    for (Eigen::Index c = 0; c < w.cols(); ++c)
      if (w(r, c) > 0) out[static_cast<std::size_t>(r)].push_back(c);
  return out;
}

// values[r][used]: sum or maximum over the assignments of the rows from r on when the columns in `used` are taken.
std::vector<std::vector<double>> completions(const Eigen::MatrixXd& w, bool maximum) {
  const auto rows = static_cast<std::size_t>(w.rows());
  const auto links = linksOf(w);
  const std::size_t masks = std::size_t{1} << w.cols();
  std::vector<std::vector<double>> values(rows + 1, std::vector<double>(masks, 1.0));
  for (std::size_t r = rows; r-- > 0;) {
    for (std::size_t used = 0; used < masks; ++used) {
      double value = values[r + 1][used];
      for (const Eigen::Index c : links[r]) {
        const std::size_t bit = std::size_t{1} << c;
        if (used & bit) continue;
        const double with = w(static_cast<Eigen::Index>(r), c) * values[r + 1][used | bit];
        value = maximum ? std::max(value, with) : value + with;
      }
      values[r][used] = value;
    }
  }
  return values;
}

Eigen::MatrixXd marginals(const Eigen::MatrixXd& w) {
  const auto after = completions(w, false);
  const auto links = linksOf(w);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(w.rows(), w.cols());
  std::vector<double> before(after[0].size(), 0.0), next;  // by the columns taken so far
  before[0] = 1;
  for (Eigen::Index r = 0; r < w.rows(); ++r) {
    next = before;
    for (std::size_t used = 0; used < before.size(); ++used) {
      if (before[used] <= 0) continue;
      for (const Eigen::Index c : links[static_cast<std::size_t>(r)]) {
        const std::size_t bit = std::size_t{1} << c;
        if (used & bit) continue;
        const double with = before[used] * w(r, c);
        next[used | bit] += with;
        out(r, c) += with * after[static_cast<std::size_t>(r) + 1][used | bit];
      }
    }
    before.swap(next);
  }
  return out / after[0][0];
}

std::vector<int> mostProbable(const Eigen::MatrixXd& w) {
  const auto after = completions(w, true);
  std::vector<int> out(static_cast<std::size_t>(w.rows()), -1);
  std::size_t used = 0;
  for (std::size_t r = 0; r < out.size(); ++r) {
    double best = after[r + 1][used];
    for (Eigen::Index c = 0; c < w.cols(); ++c) {
      const std::size_t bit = std::size_t{1} << c;
      if (used & bit) continue;
      const double with = w(static_cast<Eigen::Index>(r), c) * after[r + 1][used | bit];
      if (with > best) best = with, out[r] = static_cast<int>(c);
    }
    if (out[r] >= 0) used |= std::size_t{1} << out[r];
  }
  return out;
}

void solveComponent(const Eigen::MatrixXd& ratios, const Component& component, JointAssignment& out) {
  const Eigen::MatrixXd part = ratios(component.rows, component.columns);
  // A matching is symmetric in both sides: subsets of the smaller one are enumerated.
  const bool turned = part.cols() > part.rows();
  const Eigen::MatrixXd w = turned ? Eigen::MatrixXd(part.transpose()) : part;
  const Eigen::MatrixXd shares = marginals(w);
  out.marginal(component.rows, component.columns) = turned ? Eigen::MatrixXd(shares.transpose()) : shares;
  const std::vector<int> best = mostProbable(w);
  for (std::size_t r = 0; r < best.size(); ++r) {
    if (best[r] < 0) continue;
    const std::size_t c = static_cast<std::size_t>(best[r]), row = turned ? c : r, column = turned ? r : c;
    out.best[static_cast<std::size_t>(component.rows[row])] = static_cast<int>(component.columns[column]);
  }
}

}  // namespace

JointAssignment solveExclusive(const Eigen::MatrixXd& ratios) {
  Eigen::MatrixXd links =
      ratios.unaryExpr([](double w) { return w < kMinRatio ? 0.0 : std::min(w, kMaxRatio); });
  while (cutWeakest(links)) {
  }
  JointAssignment out;
  out.marginal = Eigen::MatrixXd::Zero(links.rows(), links.cols());
  out.best.assign(static_cast<std::size_t>(links.rows()), -1);
  for (const auto& component : componentsOf(links))
    if (!component.columns.empty()) solveComponent(links, component, out);
  out.none = (1 - out.marginal.rowwise().sum().array()).max(0);
  return out;
}

}  // namespace roomgraph
