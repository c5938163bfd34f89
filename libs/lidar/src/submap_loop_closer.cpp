// SPDX-License-Identifier: BSD-3-Clause
// Candidate submaps by drift, branch-and-bound match, ambiguity test and confirmation.
#include "submap_loop_closer.h"

#include <algorithm>
#include <cmath>

#include "corridor.h"
#include "grid_refinement.h"
#include "roomgraph/geometry/covariance.h"
#include "surface_refinement.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(SubmapLoopCloser, ScanLoopCloser, roomgraph)

namespace {
constexpr int kClosureLevels = 7;
constexpr std::size_t kPyramids = 16;   // of the submaps around the robot, with some to spare
constexpr double kTurnLength = 0.3;     // m of path that a turn by 1 rad counts for
constexpr double kVerifyHorizon_s = 3;  // a kept scan this near in time is at the proposed place
constexpr double kClosureLength = 0.3;  // m of path that a closure counts for

Pose2 movement(const WayPoint& a, const WayPoint& b) {
  return a.odom_from_robot.inverse() * b.odom_from_robot;
}
}  // namespace

SubmapLoopCloser::SubmapLoopCloser() : pyramids_(kClosureLevels, kPyramids) {}

// Where is searched, and how far around.
void SubmapLoopCloser::declareSearch(ParameterVisitor& v) {
  v.add("min_path_m", min_path_m_,
        {.doc = "A submap is searched only when the path since its last scan is at least this long.",
         .unit = "m",
         .min = 0,
         .max = 10000});
  v.add("near_m", near_m_,
        {.doc = "Submaps with a scan within this distance, plus the assumed drift, are searched.",
         .unit = "m",
         .min = 0,
         .max = 100});
  v.add("max_near_m", max_near_m_,
        {.doc = "Largest distance of submaps that are searched, drift included.",
         .unit = "m",
         .min = 0,
         .max = 1000});
  v.add("drift_per_m", drift_per_m_,
        {.doc = "Assumed drift of the translation per metre of path length.", .min = 0, .max = 1});
  v.add("drift_rad_per_m", drift_rad_per_m_,
        {.doc = "Assumed drift of the yaw per metre of path length.", .unit = "rad/m", .min = 0, .max = 1});
  v.add("window_m", window_m_,
        {.doc = "Half width of the search for the translation without drift.",
         .unit = "m",
         .min = 0,
         .max = 50});
  v.add("window_rad", window_rad_,
        {.doc = "Half width of the search for the rotation without drift.",
         .unit = "rad",
         .min = 0,
         .max = 3.2});
  v.add("max_window_m", max_window_m_,
        {.doc = "Largest half width of the search for the translation, drift included.",
         .unit = "m",
         .min = 0,
         .max = 50});
  v.add("max_window_rad", max_window_rad_,
        {.doc = "Largest half width of the search for the rotation, drift included.",
         .unit = "rad",
         .min = 0,
         .max = 3.2});
}

void SubmapLoopCloser::declareParameters(ParameterVisitor& v) {
  submap_settings_.declare(v);
  declareSearch(v);
  v.add("min_search_score", min_search_score_,
        {.doc = "The refinement starts only when the mean occupancy at the returns is at least this.",
         .min = 0,
         .max = 1});
  v.add("min_score", min_score_,
        {.doc = "Least share of the returns that the submap must explain.", .min = 0, .max = 1});
  v.add("max_contradicted", max_contradicted_,
        {.doc = "Largest share of the returns that may lie in space that the submap saw free.",
         .min = 0,
         .max = 1});
  v.add("max_wrong_side", max_wrong_side_,
        {.doc = "Largest share of the returns on known surfaces that may lie on one seen from behind.",
         .min = 0,
         .max = 1});
  v.add("ambiguity_ratio", ambiguity_ratio_,
        {.doc = "A match is ambiguous when a second pose, in this submap or after a long path in another, reaches this share of the best score.",
         .min = 0,
         .max = 1});
  v.add("trusted_path_m", trusted_path_m_,
        {.doc = "A closure over a shorter path needs no confirmation by other scans.",
         .unit = "m",
         .min = 0,
         .max = 10000});
  v.add("agreeing_closures", agreeing_closures_,
        {.doc = "Scans that must agree on a closure over a longer path.", .min = 1, .max = 100});
  v.add("agreeing_path_m", agreeing_path_m_,
        {.doc = "Path length that the scans that agree on a closure must span at least; half the half width of the search, if that is more.",
         .unit = "m",
         .min = 0,
         .max = 1000});
  v.add("max_candidates", max_candidates_,
        {.doc = "Submaps that are searched for one scan at most.", .min = 1, .max = 100});
  v.add("max_matches_per_search", max_matches_per_search_,
        {.doc = "Matches that one search for closures may try.", .min = 1, .max = 1000});
  v.add("submaps_kept", submaps_kept_,
        {.doc = "When there are more, submaps are given up where older ones hold the same place, seen in the same direction.",
         .min = 0,
         .max = 1000000});
  v.add("covariance_inflation", covariance_inflation_,
        {.doc = "Factor on the standard deviations that the curvature of the match gives.",
         .min = 0.01,
         .max = 100});
  v.add("floor_sigma_m", floor_sigma_m_,
        {.doc = "Least standard deviation of the translation of a closure.",
         .unit = "m",
         .min = 1e-6,
         .max = 1});
  v.add("floor_sigma_rad", floor_sigma_rad_,
        {.doc = "Least standard deviation of the rotation of a closure.",
         .unit = "rad",
         .min = 1e-6,
         .max = 1});
}

// Kept scan nearest in time, -1: none within the horizon.
int SubmapLoopCloser::nearestScan(double t) const {
  const auto after = std::lower_bound(scans_.begin(), scans_.end(), t, [](const Scan& scan, double time) { return scan.t < time; });
  auto best = scans_.end();
  for (const auto& it : {after == scans_.begin() ? scans_.end() : std::prev(after), after})
    if (it != scans_.end() && (best == scans_.end() || std::abs(it->t - t) < std::abs(best->t - t))) best = it;
  return best == scans_.end() || std::abs(best->t - t) > kVerifyHorizon_s ? -1 : static_cast<int>(best - scans_.begin());
}

std::optional<RelativePose> SubmapLoopCloser::verify(const RelativePose& proposed) {
  const int a = nearestScan(proposed.t_a), b = nearestScan(proposed.t_b);
  if (a < 0 || b < 0 || scans_[static_cast<std::size_t>(b)].ranges_m.empty()) return std::nullopt;  // given up
  const auto kept = keptFor(a);
  if (!kept) return std::nullopt;
  for (std::size_t s = 0; s < submaps_.size(); ++s) {
    const auto& [first, last, map] = submaps_[s];
    if (!map || kept->scan < first || kept->scan > last || b <= last) continue;
    // Just beyond what is trusted: the match must be unambiguous.
    const Candidate candidate{s, kept->scan, kept->kept_from_this * planarPart(proposed.a_from_b), 0, trusted_path_m_ + 1};
    const std::optional<Closure> found = match(candidate, probeOf(b));
    if (!found) continue;
    tie(*found);
    accept(*found);
    return toRelativePose(*found);
  }
  return std::nullopt;
}

void SubmapLoopCloser::prepare() {
  active_ = submap_settings_.emptySubmaps();
  submaps_.clear();
  examined_ = 0, given_up_ = 0;
  own_share_ = {};
  pyramids_.clear();
  scans_.clear();
  way_.clear();
  graph_ = ClosureGraph();
  stands_for_.clear();
  confirmation_ = ClosureConfirmation();
  adrift_.clear();
  tied_to_.clear();
  votes_ = PlaceVotes();
  turn_ = searched_whole_ = found_whole_ = 0;
  waiting_.clear();
}

void SubmapLoopCloser::release() {
  prepare();
}

void SubmapLoopCloser::add(const Scan& scan, const ScanMatch& match) {
  if (!active_) prepare();
  if (!match.matched) return;
  const WayPoint* last = way_.empty() ? nullptr : &way_.back();
  const bool connected = last && last->segment == match.segment;
  const MotionFilter filter = submap_settings_.filter();
  if (connected && !filter.moved(scans_.back().t, last->odom_from_robot, scan.t, match.odom_from_robot))
    return;
  if (last && !connected) store(active_->finishAll());
  if (last && match.anywhere) beginPiece(static_cast<int>(scans_.size()));

  WayPoint here{match.odom_from_robot, last ? last->path_m : 0, match.segment};
  const Pose2 step = connected ? movement(*last, here) : Pose2{};
  const double length = std::hypot(step.x, step.y) + kTurnLength * std::abs(step.yaw);
  here.path_m += length;
  graph_.addNode(connected, step, length);
  way_.push_back(here);
  scans_.push_back(scan);
  waiting_.push_back(static_cast<int>(scans_.size()) - 1);
  store(active_->insert(submap_settings_.planar(scan), match.odom_from_robot));
}

void SubmapLoopCloser::store(std::shared_ptr<Submap> submap) {
  if (!submap) return;
  submap->pack();
  const int first = submap->first_insertion;
  submaps_.push_back({first, first + submap->insertions - 1, std::move(submap)});
}

SubmapLoopCloser::Probe SubmapLoopCloser::probeOf(int scan) const {
  Probe out{scan, submap_settings_.planar(scans_[static_cast<std::size_t>(scan)]), {}};
  out.points = submap_settings_.points(out.planar);
  return out;
}

std::vector<RelativePose> SubmapLoopCloser::search(const PoseAt& world_from_robot) {
  std::vector<RelativePose> found;
  if (waiting_.empty() || submaps_.empty()) {
    waiting_.clear();
    return found;
  }
  PlacesInWorld world(world_from_robot, scans_);
  for (int matches = 0; matches < max_matches_per_search_ && !waiting_.empty(); waiting_.pop_front()) {
    const Probe b = probeOf(waiting_.front());
    const std::vector<std::size_t> untied = nextUntied(b);
    matches += static_cast<int>(untied.size());
    std::vector<Closure> closures = locate(b, untied, world);
    for (const Candidate& candidate : candidatesFor(b, world)) {
      ++matches;
      const std::optional<Closure> closure = match(candidate, b);
      if (!closure) continue;
      std::vector<Closure> now = believed(*closure, b, world);
      std::move(now.begin(), now.end(), std::back_inserter(closures));
    }
    for (const Closure& c : closures) {
      accept(c);
      found.push_back(toRelativePose(c));
    }
  }
  giveUpRepeated(world);
  return found;
}

const std::optional<Pose2>& SubmapLoopCloser::PlacesInWorld::of(int scan) {
  const auto [it, first] = known_.try_emplace(scan);
  if (first)
    if (const auto pose = world_from_robot_(scans_[static_cast<std::size_t>(scan)].t)) it->second = planarPart(*pose);
  return it->second;
}

std::vector<SubmapLoopCloser::Candidate> SubmapLoopCloser::candidatesFor(const Probe& b, PlacesInWorld& world) const {
  std::vector<Candidate> candidates;
  if (static_cast<int>(b.points.size()) < submap_settings_.min_points) return candidates;
  const ClosureGraph::Paths reached = graph_.reachedFrom(b.scan);
  for (std::size_t s = 0; s < submaps_.size(); ++s) {
    const auto candidate = nearestIn(s, b.scan, reached, world);
    if (candidate) candidates.push_back(*candidate);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.distance_m < y.distance_m; });
  if (static_cast<int>(candidates.size()) > max_candidates_)
    candidates.resize(static_cast<std::size_t>(max_candidates_));
  return candidates;
}

std::optional<SubmapLoopCloser::Candidate> SubmapLoopCloser::nearestIn(std::size_t s, int b,
                                                                       const ClosureGraph::Paths& reached,
                                                                       PlacesInWorld& world) const {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const auto& [first, last, map] = submaps_[s];
  if (!map || b <= last || way_[at(b)].path_m - way_[at(last)].path_m < min_path_m_) return std::nullopt;
  std::optional<Candidate> best;
  for (int a = first; a <= last; ++a) {
    const ClosureGraph::Reached& reach = reached[a];
    Candidate c{s, a, reach.start_from_node.inverse(), 0, reach.length_m};
    // Over a short path the composed movement is the better guess: the world may not know the last closures
    // yet.
    if (reach.length_m > trusted_path_m_) {
      const std::optional<Pose2>&there = world.of(a), &here = world.of(b);
      if (!there || !here) continue;
      c.a_from_b = there->inverse() * *here;
    }
    c.distance_m = std::hypot(c.a_from_b.x, c.a_from_b.y);
    if (!best || c.distance_m < best->distance_m) best = c;
  }
  if (!best || best->distance_m > std::min(max_near_m_, near_m_ + drift_per_m_ * best->path_m))
    return std::nullopt;
  return best;
}

SearchWindow SubmapLoopCloser::windowFor(double path_m) const {
  SearchWindow window;
  window.linear_m = std::min(max_window_m_, window_m_ + drift_per_m_ * path_m);
  window.angular_rad = std::min(max_window_rad_, window_rad_ + drift_rad_per_m_ * path_m);
  window.min_score = min_search_score_;
  return window;
}

std::optional<Closure> SubmapLoopCloser::match(const Candidate& candidate, const Probe& b) {
  const Pose2 expected = way_[static_cast<std::size_t>(candidate.a)].odom_from_robot * candidate.a_from_b;
  const auto found = fit(candidate.submap, b, expected, windowFor(candidate.path_m), candidate.path_m > trusted_path_m_);
  if (!found) return std::nullopt;
  return closureOf(candidate.a, b.scan, *found, candidate.path_m);
}

std::optional<SubmapLoopCloser::Fit> SubmapLoopCloser::fit(std::size_t number, const Probe& b, const Pose2& expected,
                                                           const SearchWindow& window, bool surely) {
  const Submap& submap = *submaps_[number].map;
  const ScorePyramid& pyramid = pyramids_.of(number, submap.grid);
  const auto coarse = correlativeSearch(pyramid, b.points, expected, window);
  if (!coarse) return std::nullopt;
  const PosePrior prior{coarse->grid_from_scan};
  GridRefinement fine = refineOnGrid(submap.grid, b.points, coarse->grid_from_scan, prior);
  if (fine.explained < min_score_ || fine.contradicted > max_contradicted_) return std::nullopt;
  const bool in_corridor = isCorridor(fine);
  if (in_corridor && fitsAlong(pyramid, b.points, fine, ambiguity_ratio_ * coarse->score)) return std::nullopt;
  const FacedScan scan = faced(b.planar);
  refineFurther(submap.surfaces, scan, prior, own_share_, fine);
  if (slides(fine)) return std::nullopt;
  if (shareOnWrongSide(submap.surfaces, scan, fine.grid_from_scan) > max_wrong_side_) return std::nullopt;
  if (surely && ambiguous(pyramid, b.points, expected, window, *coarse)) return std::nullopt;
  return Fit{fine, coarse->score, in_corridor};
}

Closure SubmapLoopCloser::closureOf(int a, int b, const Fit& fit, double path_m) const {
  const Pose2& odom_from_a = way_[static_cast<std::size_t>(a)].odom_from_robot;
  CovarianceModel model;
  model.inflation = covariance_inflation_;
  model.floor_sigma_m = floor_sigma_m_;
  model.floor_sigma_rad = floor_sigma_rad_;
  return {a, b, odom_from_a.inverse() * fit.refined.grid_from_scan, rotateCovariance(poseCovariance(fit.refined, model), -odom_from_a.yaw),
          path_m, fit.score, fit.in_corridor};
}

void SubmapLoopCloser::accept(const Closure& closure) {
  graph_.addClosure(closure.a, closure.b, closure.a_from_b, kClosureLength);
  confirmation_.accept(closure, way_, ruleFor(closure.path_m));
}

bool SubmapLoopCloser::ambiguous(const ScorePyramid& pyramid, const Points2& points, const Pose2& expected,
                                 const SearchWindow& window, const SearchResult& best) const {
  SearchWindow second = window;
  second.min_score = ambiguity_ratio_ * best.score;
  return correlativeSearch(pyramid, points, expected, second, around(best.grid_from_scan)).has_value();
}

RelativePose SubmapLoopCloser::toRelativePose(const Closure& closure) const {
  RelativePose out;
  out.t_a = scans_[static_cast<std::size_t>(closure.a)].t;
  out.t_b = scans_[static_cast<std::size_t>(closure.b)].t;
  out.a_from_b = toPose3(closure.a_from_b);
  out.covariance = planarCovariance(closure.covariance, 1);
  out.planar = true;
  out.source = "lidar";
  return out;
}

}  // namespace roomgraph
