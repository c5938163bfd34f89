// SPDX-License-Identifier: BSD-3-Clause
// Paths, gaps, errors and hindsight of a run from its trajectories.
#pragma once

#include "roomgraph/observations/trajectory.h"
#include "run_data.h"

namespace roomgraph {

/// Poses from above, t from `start_t`.
std::vector<PathPoint> seenFromAbove(const Trajectory& trajectory, double start_t);

/// Spans between neighbours that are longer than 1 s and than ten median spacings.
std::vector<std::pair<double, double>> gapsOf(const std::vector<PathPoint>& path);
/// What is longer is a gap, s: a second, or ten spacings of a slow recording.
double longestSpacing(const std::vector<PathPoint>& path);

double lengthOf(const std::vector<PathPoint>& path);

/// Errors after alignment, as `evaluate trajectory` computes them, and over time in [0, duration_s].
/// Nothing when no pose has a true one.
std::optional<ReportedErrors> errorsOf(const Trajectory& truth, const Trajectory& estimate, double start_t,
                                       double duration_s);

/// Distance between the live and the final position of the same stamp.
BinnedSeries hindsightOf(const Trajectory& live, const Trajectory& final, double start_t, double duration_s);

}  // namespace roomgraph
