// SPDX-License-Identifier: BSD-3-Clause
// Errors of cuboid proposals and of ground planes against truth.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/evaluation/class_rule.h"
#include "roomgraph/evaluation/statistics.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// The proposals of one detection, best first, and the true object.
struct ProposalCase {
  std::string class_name;
  ClassRule rule;
  ObjectShape truth;
  Pose3 camera_from_truth = Pose3::Identity();   ///< object frame: bottom centre, x front, z up
  Pose3 camera_from_ground = Pose3::Identity();  ///< frame of the proposals' covariances
  std::vector<Proposal> proposals;
  double t = 0;     ///< of the frame, s
  int object = -1;  ///< id of the true one
  Box2 box;         ///< that went in
};

/// Errors of one proposal, on the ground.
struct ProposalError {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();   ///< ground frame, estimate minus truth, m
  Eigen::Vector2d in_view = Eigen::Vector2d::Zero();  ///< the same along the view and to its left, m
  Eigen::Vector2d in_object = Eigen::Vector2d::Zero();  ///< the same in front of and to the left of the true object, m
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< width, depth and height, estimate minus truth, m
  Eigen::Vector2d sigma_in_view =
      Eigen::Vector2d::Zero();  ///< that the proposal claims, along and to the left, m
  double nees = 0;              ///< of `center` by the proposal's covariance; expected: 2
  double range_m = 0;           ///< of the proposal's centre, on the ground
  double yaw_deg = 0;           ///< modulo symmetry
  double iou3d = 0;
};

ProposalError errorOf(const Proposal& proposal, const ProposalCase& c);

/// Errors of a class. `top`: of the first proposal; `best`: the least among all proposals of a detection.
struct ProposalFigures {
  int detections = 0, without_proposal = 0;
  ErrorStatistics center_top_m, center_best_m;  ///< on the ground
  ErrorStatistics yaw_top_deg, yaw_best_deg;    ///< modulo symmetry
  double iou3d_top_median = 0, iou3d_best_median = 0;
  double share_good = 0;  ///< of all detections, those with a proposal whose 3D IoU exceeds .4
  double away_mean_m = 0, left_mean_m = 0;  ///< mean error of the top proposal along and across the view
  double nees_mean = 0, nees_median = 0;    ///< of (x, y): expected 2, and 1.39
  ErrorStatistics sigma_m;  ///< standard deviation that the top proposals claim: root of trace / 2
};

std::map<std::string, ProposalFigures> evaluateProposals(const std::vector<ProposalCase>& cases);

/// One frame's ground plane and the true one, both in the camera frame.
struct GroundCase {
  Plane truth;
  std::optional<GroundEstimate> estimate;
};

struct GroundFigures {
  int frames = 0, found = 0;
  ErrorStatistics angle_deg, height_m;  ///< of planes that were found in the depth
  double share_good = 0;                ///< of them, those within 1 deg and .02 m
  int wrong = 0;                        ///< accepted, but off by more than 3 deg or .1 m
  double nees_mean = 0;                 ///< of (tilt about two axes, height): expected 3
};

GroundFigures evaluateGround(const std::vector<GroundCase>& cases);

}  // namespace roomgraph
