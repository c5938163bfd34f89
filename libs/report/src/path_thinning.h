// SPDX-License-Identifier: BSD-3-Clause
// Fewer points for the same picture: paths by Douglas and Peucker, series by smallest and largest value.
#pragma once

#include "run_data.h"

namespace roomgraph {

/// Indices of the points to keep so that no point is farther than `tolerance_m` from where the line that is left is at
/// its time (after D. Douglas and T. Peucker 1973). First and last are kept, and both ends of each gap of more than
/// `longest_s`.
std::vector<std::size_t> keptPoints(const std::vector<PathPoint>& path, double tolerance_m, double longest_s);

/// The path with 1 cm tolerance, or the finest doubling of it that leaves at most `most` points; where the gaps alone
/// have more, with these.
std::vector<PathPoint> thinned(const std::vector<PathPoint>& path, std::size_t most, double longest_s);

/// Number of parts for a series of so many values: at least two values in each on average.
int partsFor(std::size_t values, int most);

/// Smallest and largest value of (t, value) in each of `bins` equal parts of [from, to]; others are left out.
BinnedSeries binned(const std::vector<std::pair<double, double>>& values, double from, double to, int bins);

}  // namespace roomgraph
