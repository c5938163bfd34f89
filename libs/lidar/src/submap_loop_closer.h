// SPDX-License-Identifier: BSD-3-Clause
// Loop closing of lidar scans against older submaps.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>

#include "closure_confirmation.h"
#include "closure_graph.h"
#include "correlative_search.h"
#include "grid_refinement.h"
#include "own_share.h"
#include "place_votes.h"
#include "roomgraph/lidar/scan_matcher.h"
#include "score_pyramid.h"
#include "submap_settings.h"

namespace roomgraph {

/// Finds returns by matching kept scans against older submaps: branch-and-bound search as wide as the drift
/// may be, refinement, and for returns after a long path the agreement of several scans. After Hess et al.
/// 2016, sec. V. A segment of which nothing tells where it is (ScanMatch::anywhere) is looked for in all of every submap.
class SubmapLoopCloser : public ScanLoopCloser {
  DEFINE_MRPT_OBJECT(SubmapLoopCloser, roomgraph)
 public:
  SubmapLoopCloser();
  void declareParameters(ParameterVisitor& visitor) override;
  void prepare() override;
  void add(const Scan& scan, const ScanMatch& match) override;
  std::vector<RelativePose> search(const PoseAt& world_from_robot) override;
  std::optional<RelativePose> verify(const RelativePose& proposed) override;
  void release() override;
  /// Submaps that were not given up.
  int submapsHeld() const { return static_cast<int>(submaps_.size()) - given_up_; }

 private:
  void declareSearch(ParameterVisitor& v);
  /// A kept scan as it is matched, robot frame.
  struct Probe {
    int scan = 0;
    PlanarScan planar;
    Points2 points;  ///< thinned
  };
  /// A finished submap with the numbers of its first and last scan.
  struct KeptSubmap {
    int first = 0, last = 0;
    std::shared_ptr<const Submap> map;  ///< null: given up
  };
  /// Where kept scans are in world, looked up once each; nothing where the world does not know.
  class PlacesInWorld {
   public:
    PlacesInWorld(const PoseAt& world_from_robot, const std::vector<Scan>& scans) : world_from_robot_(world_from_robot), scans_(scans) {}
    const std::optional<Pose2>& of(int scan);

   private:
    const PoseAt& world_from_robot_;
    const std::vector<Scan>& scans_;
    std::unordered_map<int, std::optional<Pose2>> known_;
  };
  struct Fit {
    GridRefinement refined;
    double score = 0;  ///< mean occupancy at the returns, before
    bool in_corridor = false;
  };
  struct Candidate {
    std::size_t submap = 0;
    int a = 0;              ///< kept scan of the submap next to the scan
    Pose2 a_from_b;         ///< expected
    double distance_m = 0;  ///< between the two
    double path_m = 0;      ///< path length between the two
  };

  void store(std::shared_ptr<Submap> submap);
  Probe probeOf(int scan) const;
  std::vector<Candidate> candidatesFor(const Probe& b, PlacesInWorld& world) const;
  std::optional<Candidate> nearestIn(std::size_t submap, int b, const ClosureGraph::Paths& reached,
                                     PlacesInWorld& world) const;
  SearchWindow windowFor(double path_m) const;
  std::optional<Closure> match(const Candidate& candidate, const Probe& b);
  /// Nothing when the submap does not explain the scan there or, if it is asked for `surely`, explains it elsewhere as well.
  std::optional<Fit> fit(std::size_t submap, const Probe& b, const Pose2& expected, const SearchWindow& window, bool surely);
  Closure closureOf(int a, int b, const Fit& fit, double path_m) const;
  /// What is believed now that there is this closure: itself, others that waited for it, or nothing yet.
  std::vector<Closure> believed(const Closure& closure, const Probe& b, PlacesInWorld& world);
  ConfirmationRule ruleFor(double path_m) const;
  /// Whether another place, as far around as twice the assumed drift, explains the first one's scan, and with it all of the others', about as well.
  bool fitElsewhere(const std::vector<Closure>& agreeing, const Probe& b, PlacesInWorld& world);
  /// Of the others' scans, whether all fit in a submap where they would be with the first one's at that place.
  bool goAlong(const std::vector<Closure>& agreeing, std::size_t submap, const Pose2& grid_from_first);
  /// Of a submap's scans, all older than b, the nearest to it by the world; -1: none within reach.
  int nearestScanOf(const KeptSubmap& submap, int b, double reach_m, PlacesInWorld& world) const;
  void accept(const Closure& closure);
  /// What is the same solution.
  static ExcludedPose around(const Pose2& grid_from_scan) { return {grid_from_scan, 0.6, 0.3}; }
  /// The path falls into pieces where nothing tells how the robot moved; those that closures tie have the number of the first of them.
  int pieceOf(int scan) const;
  void beginPiece(int scan);
  void tie(const Closure& closure);
  /// Those of other pieces.
  std::vector<std::size_t> untiedSubmaps(int scan) const;
  /// The untied submaps whose turn it is.
  std::vector<std::size_t> nextUntied(const Probe& b);
  /// Looks in all of these; closures once enough scans agree.
  std::vector<Closure> locate(const Probe& b, const std::vector<std::size_t>& submaps, PlacesInWorld& world);
  /// A closure between two pieces; closures, which tie them, once enough scans agree and none of the other submaps explains the scan as well.
  std::vector<Closure> vote(const Closure& closure, const Probe& b, PlacesInWorld& world);
  bool hasRival(const Closure& closure, const Probe& b, PlacesInWorld& world);
  std::optional<Closure> matchAnywhere(std::size_t submap, const Probe& b);
  int nearestScan(double t) const;
  /// Submaps whose places older ones hold are given up: memory, and the time of a search, grow with the area seen, not with time.
  void giveUpRepeated(PlacesInWorld& world);
  bool isRepeated(const KeptSubmap& submap, PlacesInWorld& world) const;
  void giveUp(KeptSubmap& submap);
  /// A scan of a submap that is kept, and its movement to this one: itself, or the nearest by ways over closures.
  struct KeptScan {
    int scan;
    Pose2 kept_from_this;
  };
  std::optional<KeptScan> keptFor(int scan) const;
  std::vector<int> scansHeldBefore(int scan) const;
  bool ambiguous(const ScorePyramid& pyramid, const Points2& points, const Pose2& expected,
                 const SearchWindow& window, const SearchResult& best) const;
  RelativePose toRelativePose(const Closure& closure) const;

  SubmapSettings submap_settings_{.keep_distance_m = 0.2,
                                  .keep_angle_rad = 0.17453,
                                  .keep_time_s = 10,
                                  .max_points = 150,
                                  .min_points = 40};
  double min_path_m_ = 4;
  double near_m_ = 3, max_near_m_ = 12;
  double drift_per_m_ = 0.03, drift_rad_per_m_ = 0.0087266;
  double window_m_ = 0.3, window_rad_ = 0.13963, max_window_m_ = 6, max_window_rad_ = 1.0472;
  double min_search_score_ = 0.5, min_score_ = 0.75, max_contradicted_ = 0.15;
  double max_wrong_side_ = 0.15;
  double ambiguity_ratio_ = 0.93;
  double trusted_path_m_ = 8;
  int agreeing_closures_ = 3;
  double agreeing_path_m_ = 1;
  int max_candidates_ = 2, max_matches_per_search_ = 12, submaps_kept_ = 40;
  double covariance_inflation_ = 1, floor_sigma_m_ = 0.02, floor_sigma_rad_ = 0.005236;

  std::unique_ptr<ActiveSubmaps> active_;
  std::vector<KeptSubmap> submaps_;
  std::size_t examined_ = 0;  ///< submaps that were looked at whether they repeat older ones
  int given_up_ = 0;          ///< of them
  OwnShare own_share_;
  RecentPyramids pyramids_;  ///< of submaps, by index
  std::vector<Scan> scans_;  ///< kept ones
  std::vector<WayPoint> way_;  ///< one per kept scan
  ClosureGraph graph_;           ///< of kept scans, without those that were given up
  std::vector<int> adrift_;      ///< kept scans with which a piece of the path begins; the first piece has none
  std::vector<int> tied_to_;     ///< by piece after the first: the first of those that it is tied to
  PlaceVotes votes_;
  std::size_t turn_ = 0;  ///< of the untied submaps
  std::size_t searched_whole_ = 0, found_whole_ = 0;  ///< since the last piece began: submaps, and those that explained the scan
  std::map<int, KeptScan> stands_for_;  ///< by scan that was given up: the nearest of an older submap
  ClosureConfirmation confirmation_;
  std::deque<int> waiting_;  ///< kept scans not searched yet
};

}  // namespace roomgraph
