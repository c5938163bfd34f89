// SPDX-License-Identifier: BSD-3-Clause
// Landmarks of three classes, frames with them, and what a run knows of them, for the evidence for existence.
#pragma once

#include <gtest/gtest.h>

#include "existence_evidence.h"
#include "still_camera.h"

namespace roomgraph::test {

inline const ObjectDatabase& database() {
  static const ObjectDatabase out = ObjectDatabase::fromText(
      "[chair]\nlabels = chair\nshape = cylinder\nwidth_m = .6\ndepth_m = .6\nheight_m = .9\n"
      "width_sigma_m = .1\ndepth_sigma_m = .1\nheight_sigma_m = .1\nsymmetry = 0\n"
      "[sofa]\nlabels = sofa\nshape = cuboid\nwidth_m = 1.8\ndepth_m = .8\nheight_m = .8\nsolid_share = .5\n"
      "[door]\nlabels = door\nshape = planar\nwidth_m = .9\ndepth_m = .1\nheight_m = 2\nsymmetry = 2\n");
  return out;
}

inline Landmark landmarkOf(int id, const std::string& class_name, double x, double y) {
  Landmark out;
  out.id = LandmarkId{id};
  out.class_name = class_name;
  out.shape = database().find(class_name)->nominal();
  out.position = {x, y, 0};
  out.existence = 0.9;
  out.class_posterior = {{class_name, 0.75}, {"other", 0.25}};
  out.observations = 10;
  return out;
}

// Seen as its landmark is, in a frame without depth.
inline ObjectFrame frameWith(int i, double t, const std::vector<Landmark>& seen) {
  const Frame frame = frameAt(i, t);
  ObjectFrame out{frame.id, t, frame.camera, frame.robot_from_camera, {}, {}};
  for (const auto& landmark : seen) {
    ObjectDecision decision;
    decision.landmark = landmark.id;
    decision.seen.world_from_object = landmark.worldFromObject();
    auto& measurement = decision.seen.measurement;
    measurement.proposal.class_name = landmark.class_name;
    measurement.proposal.score = 0.5;
    const auto projected = projectShape(
        landmark.shape, frame.robot_from_camera.inverse() * landmark.worldFromObject(), frame.camera);
    measurement.detection.box = projected->visible;
    out.decisions.push_back(decision);
  }
  return out;
}

class Evidence : public ::testing::Test {
 protected:
  Evidence() : poses_(standing()) { poses_.add(0, Pose3::Identity()); }

  ExistenceEvidence of(const std::vector<Landmark>& landmarks) const {
    return existenceEvidence(landmarks, frames_, poses_, memory_.posed(poses_), database(), searched_).at(0);
  }

  // This image alone is remembered.
  void see(const Frame& frame) {
    memory_ = {};
    memory_.add(frame, Pose3::Identity());
  }

  KeyPoses poses_;
  SpaceMemory memory_;
  std::vector<ObjectFrame> frames_;
  std::vector<SearchedImage> searched_;
};

}  // namespace roomgraph::test
