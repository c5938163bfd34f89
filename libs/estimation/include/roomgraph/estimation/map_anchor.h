// SPDX-License-Identifier: BSD-3-Clause
// Localisation in an earlier map by objects, scans and images.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "roomgraph/association/constellation.h"
#include "roomgraph/estimation/graph_builder.h"
#include "roomgraph/estimation/place_consensus.h"
#include "roomgraph/lidar/grid_locator.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/scan.h"
#include "roomgraph/tracking/key_views.h"

namespace roomgraph {

/// How a run was laid into the frame of an earlier map.
struct Anchoring {
  Pose3 map_from_world = Pose3::Identity();
  double t = 0;                      ///< s, when it was known
  std::vector<PlaceSource> sources;  ///< that agreed on it
};

/// An earlier map in whose frame the run is to be (method.md sec. 4.9). Objects, scans and images each say
/// where in it the robot is; what enough of them agree on is believed, and afterwards scans and images hold
/// the run in the map.
class MapAnchor {
 public:
  MapAnchor(CSemanticMap map, const RelocalisationOptions& options,
            const ConstellationOptions& constellation);

  const CSemanticMap& map() const { return map_; }
  /// Set once the place in the map is known; the world is now the map's frame.
  const std::optional<Anchoring>& anchoring() const { return anchoring_; }

  /// The latest scan and image, after the pose of their time is known. `people`: regions of the image, px.
  void add(const Scan& scan, const KeyPoses& poses);
  void add(const Frame& frame, const std::vector<Box2>& people, const KeyPoses& poses);

  /// map_from_world at the moment at which it is known, once; the caller moves its world there. `planar`: the
  /// robot drives on the floor, so that only x, y and yaw are unknown. There must be a key pose.
  std::optional<Pose3> recognise(const std::vector<Landmark>& seen, const KeyPoses& poses, bool planar);

  /// Where in the map the robot is by the latest scan, or image where there are no scans, once for each
  /// stretch of way; nothing when it does not fit the map where the robot is.
  std::optional<MapFix> fix(const KeyPoses& poses);

 private:
  struct KeptScan {
    double t;
    std::vector<Eigen::Vector2d> in_robot;
  };
  struct ViewAt {
    double t;
    Pose3 map_from_robot;
  };

  bool hasScans() const { return locator_ && !scans_.empty(); }
  /// Whether the lidar still tells where the robot is.
  bool grounded() const;
  /// Until the next search, after so long without success.
  double pause(double quick_s, double since_s) const;
  std::vector<Eigen::Vector2d> recentReturns(const KeyPoses& poses) const;
  std::optional<GridFit> fitOnWalls(const Pose2& map_from_robot, const KeyPoses& poses) const;
  void sightByObjects(const std::vector<Landmark>& seen, const KeyPoses& poses);
  void sightByScans(const KeyPoses& poses);
  void sightByImage(const KeyPoses& poses, bool planar);
  void sight(PlaceSource source, double t, const Pose3& map_from_robot, const KeyPoses& poses);
  std::optional<MapFix> fixByScan(const KeyPoses& poses) const;

  CSemanticMap map_;
  RelocalisationOptions options_;
  ConstellationOptions constellation_;
  std::unique_ptr<GridLocator> locator_;  ///< null: the map has no grid
  ViewLocator views_;
  PlaceConsensus consensus_;
  std::vector<KeptScan> scans_;  ///< of the last metres, the latest one last
  std::optional<ViewAt> view_;   ///< by the latest image that was recognised, until it was used
  double next_search_t_ = 0, next_view_t_ = 0, first_t_ = 0, latest_t_ = 0, fixed_scan_t_ = -1;
  std::optional<Pose3> last_fix_from_;
  std::optional<Anchoring> anchoring_;
};

}  // namespace roomgraph
