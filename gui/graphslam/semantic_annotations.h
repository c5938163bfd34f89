// SPDX-License-Identifier: BSD-3-Clause
// Annotations of the nodes of a pose network: the objects seen from there; networks with them.
#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>
#include <mrpt/graphs/TNodeAnnotations.h>

#include <string>
#include <type_traits>
#include <vector>

#include "roomgraph/graphslam/seen_object.h"

namespace roomgraph {

/// Objects seen from a node. Dijkstra's estimate, which makes all nodes anew, copies them.
struct SemanticAnnotations : mrpt::graphs::detail::TNodeAnnotations {
  DECLARE_TTYPENAME_CLASSNAME(roomgraph::SemanticAnnotations)

  std::vector<SeenObject> objects;

  void getAnnotsAsString(std::string* text) const override { *text = describe(objects); }
  // The network calls these by name on the annotations' own type; the caller deletes the copy.
  SemanticAnnotations* getCopyOfAnnots() const { return new SemanticAnnotations(*this); }
  bool setAnnots(const mrpt::graphs::detail::TNodeAnnotations& other) {
    const auto* same = dynamic_cast<const SemanticAnnotations*>(&other);
    if (same) *this = *same;
    return same != nullptr;
  }
};

/// CNetworkOfPoses2DInf and CNetworkOfPoses3DInf, with annotations.
using SemanticNetwork2D =
    mrpt::graphs::CNetworkOfPoses<mrpt::poses::CPosePDFGaussianInf, mrpt::containers::map_traits_stdmap,
                                  SemanticAnnotations>;
using SemanticNetwork3D =
    mrpt::graphs::CNetworkOfPoses<mrpt::poses::CPose3DPDFGaussianInf, mrpt::containers::map_traits_stdmap,
                                  SemanticAnnotations>;

/// Whether the poses of a network lie in the plane.
template <class GRAPH>
inline constexpr bool kPlanar = !GRAPH::constraint_t::is_3D_val;

/// World_from_robot of a node.
template <class Pose>
Pose3 poseOf(const Pose& node) {
  return toPose3(mrpt::poses::CPose3D(node));
}

/// The part of a pose that a node of the network has.
template <class GRAPH>
typename GRAPH::constraint_no_pdf_t toNode(const Pose3& world_from_robot) {
  return typename GRAPH::constraint_no_pdf_t(toMrpt(world_from_robot));
}

}  // namespace roomgraph
