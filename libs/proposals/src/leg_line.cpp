// SPDX-License-Identifier: BSD-3-Clause
// Steep segments extended to the bottom of the box and their agreement.
#include "leg_line.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kSteep = 0.2;      // largest ratio of horizontal to vertical extent of a leg
constexpr double kVoteSteep = 1.0;  // the same of a segment that may vote
constexpr double kLower = 0.5;      // part of the box above which the middle of no leg lies
constexpr double kMargin = 0.15;    // of the box's width, at both sides: chair feet and arm rests
constexpr double kBeside = 0.08;    // of the box's width, between both sides of a tube
constexpr double kLegLength = 0.1;  // of the box's height, at least
constexpr double kLegGap = 1.5;     // of its own length: the farthest a leg is extended
constexpr std::size_t kVotes = 5;

struct Steep {
  double column = 0, length = 0, gap = 0;  // px; gap: from its lower end to the bottom line
};

// Extended to the bottom line; nothing for a flat segment or one in the upper part.
std::optional<Steep> extended(const Segment2& s, const Box2& box, double steepness) {
  const Eigen::Vector2d &low = s.a.y() > s.b.y() ? s.a : s.b, &high = s.a.y() > s.b.y() ? s.b : s.a;
  const Eigen::Vector2d along = low - high;
  if (along.y() < 1 || std::abs(along.x()) > steepness * along.y()) return std::nullopt;
  if ((low.y() + high.y()) / 2 < box.v_min + kLower * box.height()) return std::nullopt;
  const double gap = box.v_max - low.y(), column = low.x() + along.x() / along.y() * gap;
  const double inset = kMargin * box.width();
  if (column < box.u_min + inset || column > box.u_max - inset) return std::nullopt;
  return Steep{column, along.norm(), gap};
}

}  // namespace

LegLine findLeg(const std::vector<Segment2>& segments, const Box2& box) {
  LegLine out;
  std::optional<Steep> longest;
  double sum = 0, weight = 0;
  for (const Segment2& s : segments) {  // longest first
    if (const auto vote = extended(s, box, kVoteSteep); vote && out.votes.size() < kVotes)
      out.votes.push_back(vote->column);
    const auto leg = extended(s, box, kSteep);
    if (!leg || leg->length < kLegLength * box.height() || leg->gap > kLegGap * leg->length) continue;
    if (!longest) longest = leg;
    if (std::abs(leg->column - longest->column) > kBeside * box.width()) continue;
    sum += leg->length * leg->column;
    weight += leg->length;
  }
  if (weight > 0) out.column = sum / weight;
  return out;
}

}  // namespace roomgraph
