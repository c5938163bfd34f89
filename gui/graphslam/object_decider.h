// SPDX-License-Identifier: BSD-3-Clause
// Edge registration decider of objects: closures, annotations of nodes, and how the objects are drawn.
#pragma once

#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CText.h>

#include <algorithm>

#include "closure_decider.h"
#include "roomgraph/graphslam/seen_object.h"
#include "roomgraph/rendering/palette.h"

namespace roomgraph {

/// The objects of an annotated network; those of `wanted` alone.
template <class GRAPH>
std::map<LandmarkId, PlacedObject> objectsIn(const GRAPH& graph, const std::set<LandmarkId>& wanted) {
  std::vector<std::pair<Pose3, std::vector<SeenObject>>> nodes;
  for (const auto& [id, node] : graph.nodes) nodes.emplace_back(poseOf(node), node.objects);
  auto out = placeObjects(nodes);
  std::erase_if(out, [&](const auto& entry) { return !wanted.contains(entry.first); });
  return out;
}

/// Takes over what was seen since the last call.
template <class GRAPH>
void annotateNodes(GRAPH& graph, EngineFrontEnd& front_end) {
  for (auto& [id, seen] : front_end.takeSeenObjects()) {
    auto& objects = graph.nodes.at(static_cast<mrpt::graphs::TNodeID>(id.value)).objects;
    const auto before = std::find_if(objects.begin(), objects.end(),
                                     [&](const auto& other) { return other.landmark == seen.landmark; });
    if (before != objects.end())
      *before = seen;
    else
      objects.push_back(seen);
  }
}

/// Registers the loops that objects close, and annotates each node with the landmarks seen nearest to it.
template <class GRAPH>
class CObjectClosuresERD : public CClosuresERD<GRAPH> {
 public:
  explicit CObjectClosuresERD(EngineFrontEnd& front_end)
      : CClosuresERD<GRAPH>("CObjectClosuresERD", "ICP3D", front_end,
                            [](EngineFrontEnd& f) { return f.takeObjectClosures(); }) {}

  void updateVisuals() override {
    mrpt::graphslam::CRegistrationDeciderOrOptimizer<GRAPH>::updateVisuals();
    auto& scene = this->m_win->get3DSceneAndLock();
    if (const auto former = scene->getByName(kDrawn)) scene->removeObject(former);
    auto drawn = mrpt::opengl::CSetOfObjects::Create();
    drawn->setName(kDrawn);
    for (const auto& [id, object] : objectsIn(*this->m_graph, this->frontEnd().confirmedLandmarks()))
      draw(id, object, *drawn);
    scene->insert(drawn);
    this->m_win->unlockAccess3DScene();
    this->m_win->forceRepaint();
  }

 protected:
  void afterNodes(mrpt::graphs::TNodeID first_new) override {
    auto& nodes = this->m_graph->nodes;
    // A node decider begins a node as a copy of the one before.
    for (auto node = nodes.lower_bound(first_new); node != nodes.end(); ++node) node->second.objects.clear();
    annotateNodes(*this->m_graph, this->frontEnd());
  }

 private:
  static constexpr const char* kDrawn = "semantic_landmarks";

  // "#rrggbb" of the object database.
  mrpt::img::TColor colorOf(const std::string& class_name) const {
    return palette::withAlpha(palette::ofClass(this->frontEnd().setup().database, class_name), 200);
  }

  void draw(LandmarkId id, const PlacedObject& object, mrpt::opengl::CSetOfObjects& into) const {
    const Eigen::Vector3d& p = object.position;
    const mrpt::poses::CPose3D pose(p.x(), p.y(), p.z(), object.yaw, 0, 0);
    const double depth = object.size_m.y(), width = object.size_m.x(), height = object.size_m.z();
    auto box = mrpt::opengl::CBox::Create(mrpt::math::TPoint3D(-depth / 2, -width / 2, 0),
                                          mrpt::math::TPoint3D(depth / 2, width / 2, height));
    box->setColor_u8(colorOf(object.class_name));
    box->setPose(pose);
    into.insert(box);
    auto name = mrpt::opengl::CText::Create(object.class_name + " " + std::to_string(id.value));
    name->setPose(mrpt::poses::CPose3D(p.x(), p.y(), p.z() + height + 0.1, 0, 0, 0));
    name->setColor_u8(mrpt::img::TColor(0, 0, 0));
    into.insert(name);
  }
};

}  // namespace roomgraph
