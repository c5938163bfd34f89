// SPDX-License-Identifier: BSD-3-Clause
// Ranks with ties, exact law by counting, normal law for large samples.
#include "roomgraph/catalogue/signed_rank.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace roomgraph {
namespace {

constexpr std::size_t kCountedExactly = 60;

// Twice the ranks, so that the mean ranks of ties are whole numbers; and the sum of t^3 - t over groups of t
// ties.
struct DoubledRanks {
  std::vector<std::size_t> ranks;
  double ties = 0;
};

DoubledRanks doubledRanks(const std::vector<double>& sizes) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] < sizes[b]; });
  DoubledRanks out{std::vector<std::size_t>(sizes.size())};
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && sizes[order[end]] == sizes[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i)
      out.ranks[order[i]] = begin + end + 1;  // twice the mean of begin + 1 ... end
    const double tied = static_cast<double>(end - begin);
    out.ties += tied * tied * tied - tied;
  }
  return out;
}

// Share of all choices of signs in which the doubled statistic is at most that far from its mean's side.
double exactPValue(const std::vector<std::size_t>& ranks, std::size_t statistic) {
  const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  std::vector<double> share(total + 1, 0.0);
  share[0] = 1;
  for (const std::size_t rank : ranks)
    for (std::size_t sum = total + 1; sum-- > 0;)
      share[sum] = 0.5 * (share[sum] + (sum >= rank ? share[sum - rank] : 0.0));
  const std::size_t smaller = std::min(statistic, total - statistic);
  return std::min(
      1.0, 2 * std::accumulate(share.begin(), share.begin() + static_cast<std::ptrdiff_t>(smaller) + 1, 0.0));
}

double normalPValue(double n, double statistic, double ties) {
  const double mean = n * (n + 1) / 4;
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - ties / 48;
  const double away = std::max(0.0, std::abs(statistic - mean) - 0.5);
  return std::erfc(away / std::sqrt(2 * variance));
}

}  // namespace

SignedRankTest signedRankTest(const std::vector<double>& differences) {
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double difference : differences) {
    if (difference == 0) continue;
    sizes.push_back(std::abs(difference));
    positive.push_back(difference > 0);
  }
  if (sizes.empty()) return {};
  const DoubledRanks doubled = doubledRanks(sizes);
  std::size_t sum = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (positive[i]) sum += doubled.ranks[i];
  const double statistic = static_cast<double>(sum) / 2;
  const double p = sizes.size() <= kCountedExactly
                       ? exactPValue(doubled.ranks, sum)
                       : normalPValue(static_cast<double>(sizes.size()), statistic, doubled.ties);
  return {sizes.size(), statistic, p};
}

std::vector<double> holmAdjusted(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> out(p_values.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - i) * p_values[order[i]]));
    out[order[i]] = largest;
  }
  return out;
}

}  // namespace roomgraph
