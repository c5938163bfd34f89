// SPDX-License-Identifier: BSD-3-Clause
// Scenes of chairs and sofas with rival proposals, occluders and flickering boxes; counting of right choices.
#include "selection_scenes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/selection/register_classes.h"
#include "scene_maker.h"

namespace roomgraph::test {
namespace {

// The lower side hidden, at random also one beside it.
BoxSides lowerSides(Random& random) {
  BoxSides hidden;
  hidden.bottom = true;
  hidden.left = random.index(3) == 0;
  return hidden;
}

}  // namespace

namespace {

// A chair in 12 frames, occluded from frame `enters` to before frame `leaves`.
Scene occludedChair(unsigned seed, Random& layout, int enters, int leaves) {
  const double range = layout.uniform(2.5, 4), nearer = layout.uniform(.6, .78),
               drive = layout.uniform(-.04, .04);
  const bool sofa = layout.index(2) == 1;
  SceneMaker maker(seed, {chairAt(range, layout.uniform(-.4, .4)), sofaAt(5, 2.2, 0)});
  for (int f = 0; f < 12; ++f) {
    maker.look(drive * f, 0, 0);
    const bool occluded = f >= enters && f < leaves;
    Box2 box = maker.boxOf(0);
    const double split = box.v_min + maker.random.uniform(.5, .7) * box.height();
    const Box2 occluder{box.u_min - 30, split, box.u_max + 20, 480};
    if (occluded) box.v_max = split;
    maker.detect(0, box, maker.random.uniform(.7, .95));
    const double score = maker.random.uniform(.2, .6);
    if (occluded) {
      const BoxSides hidden = lowerSides(maker.random);
      maker.proposeTrue(0, score, hidden);
      maker.proposeAtDepth(0, nearer, score + maker.random.uniform(.3, .8), hidden);
      maker.detect(-1, occluder, .8);  // the occluder itself: a person
      maker.scene.back().proposals.detections.back().class_name = "person";
    } else {
      maker.proposeTrue(0, score);
      maker.proposeAtDepth(0, nearer, score - maker.random.uniform(0, .4), {});
    }
    if (sofa) {
      maker.detect(1, maker.boxOf(1), .9);
      maker.proposeTrue(1, .7);
    }
    maker.track(occluded ? std::vector{occluder} : std::vector<Box2>{});
  }
  return maker.scene;
}

}  // namespace

Scene occluderEnters(unsigned seed) {
  Random layout(seed + 1);
  const int enters = 3 + layout.index(3);
  return occludedChair(seed, layout, enters, enters + 2 + layout.index(3));
}

Scene occluderLeaves(unsigned seed) {
  Random layout(seed + 8);
  return occludedChair(seed, layout, 0, 3 + layout.index(3));
}

Scene boxFlickers(unsigned seed) {
  Random layout(seed + 2);
  SceneMaker maker(seed, {sofaAt(layout.uniform(3.5, 4.5), 1.3, M_PI + layout.uniform(-.25, .25)),
                          sofaAt(layout.uniform(3.5, 4.5), -1.3, M_PI + layout.uniform(-.25, .25))});
  const double drive = layout.uniform(-.03, .03);
  for (int f = 0; f < 15; ++f) {
    maker.look(drive * f, 0, 0);
    for (int k = 0; k < 2; ++k) {
      if (f > 0 && maker.random.uniform(0, 1) < .2) continue;
      Box2 box = maker.boxOf(k);
      const bool halved = f > 0 && maker.random.uniform(0, 1) < .33;
      const bool left = maker.random.index(2) == 0;
      if (halved) (left ? box.u_max : box.u_min) = box.center().x();
      maker.detect(k, box, maker.random.uniform(.7, .95));
      const double score = maker.random.uniform(.4, .9);
      Pose3 turned = maker.inCamera(k) * poseFromYpr(0, 0, 0, M_PI / 2, 0, 0);
      if (halved) turned.translation().x() += (left ? -.25 : .25) * maker.at(k).shape.width;
      // One half of the box is what a detector's mask says, too: the depth of the other half is not used.
      BoxSides open;
      if (halved) (left ? open.right : open.left) = maker.random.index(2) == 0;
      maker.proposeTrue(k, score - (halved ? maker.random.uniform(0, .3) : 0), open);
      maker.propose(false, maker.at(k).shape, turned, score, open);
    }
    maker.track();
  }
  return maker.scene;
}

Scene twoDepthsCompete(unsigned seed) {
  Random layout(seed + 3);
  const double scale = layout.index(2) == 0 ? layout.uniform(.65, .8) : layout.uniform(1.25, 1.5);
  SceneMaker maker(seed, {chairAt(layout.uniform(2.5, 3.5), layout.uniform(-.5, .5))});
  const double drive = layout.uniform(-.04, .04);
  for (int f = 0; f < 15; ++f) {
    maker.look(0, drive * f, 0);
    Box2 box = maker.boxOf(0);
    const Box2 table{0, box.v_min + .55 * box.height(), 640, 480};
    box.v_max = table.v_min;
    maker.detect(0, box, maker.random.uniform(.7, .95));
    BoxSides hidden;
    hidden.bottom = true;
    maker.proposeTrue(0, maker.random.uniform(.3, .9), hidden);
    maker.proposeAtDepth(0, scale, maker.random.uniform(.3, 1), hidden);
    maker.track({table}, {1});
  }
  return maker.scene;
}

Scene chairsChangeOrder(unsigned seed) {
  Random layout(seed + 4);
  const double apart = layout.uniform(.45, .7), step = layout.uniform(.06, .12);
  SceneMaker maker(seed, {chairAt(apart, 0), chairAt(-apart, 0)});
  for (double angle = 1.1; angle >= -1.1; angle -= step) {
    maker.look(4 * std::cos(angle), 4 * std::sin(angle), angle + M_PI);
    const int near = maker.inCamera(0).translation().z() < maker.inCamera(1).translation().z() ? 0 : 1;
    const int far = 1 - near;
    const Box2 front = maker.boxOf(near), whole = maker.boxOf(far);
    Box2 rest = whole;  // what the nearer one leaves
    BoxSides hidden;
    const bool overlap = !intersection(front, whole).empty();
    if (overlap && front.center().x() < whole.center().x()) {
      rest.u_min = front.u_max;
      hidden.left = true;
    } else if (overlap) {
      rest.u_max = front.u_min;
      hidden.right = true;
    }
    maker.detect(near, front, maker.random.uniform(.7, .95));
    maker.proposeTrue(near, maker.random.uniform(.5, .9));
    if (rest.width() > .25 * whole.width()) {
      maker.detect(far, rest, maker.random.uniform(.7, .95));
      const double score = maker.random.uniform(.2, .6);
      maker.proposeTrue(far, score, hidden);
      const double scale = maker.inCamera(near).translation().z() / maker.inCamera(far).translation().z();
      if (overlap) maker.proposeAtDepth(far, scale, score + maker.random.uniform(.2, .8), hidden);
    }
    maker.track({front}, {near});
  }
  return maker.scene;
}

Scene chairIsMoved(unsigned seed) {
  Random layout(seed + 7);
  const double range = layout.uniform(2.5, 3.5), scale = layout.index(2) == 0 ? .75 : 1.3;
  const int moves = 4 + layout.index(3);
  SceneMaker maker(seed, {chairAt(range, layout.uniform(-.3, .3))});
  const double toward = layout.uniform(-1, 1), aside = layout.index(2) == 0 ? -.8 : .8;
  for (int f = 0; f < 12; ++f) {
    maker.look(.02 * f, 0, 0);
    if (f >= moves && f < moves + 3) maker.move(0, {toward / 3, aside / 3, 0});
    maker.detect(0, maker.boxOf(0), maker.random.uniform(.7, .95));
    const double score = maker.random.uniform(.3, .8);
    maker.proposeTrue(0, score);
    maker.proposeAtDepth(0, scale, score + maker.random.uniform(-.2, .5), {.bottom = true});
    maker.track();
  }
  return maker.scene;
}

Scene weakObject(unsigned seed) {
  Random layout(seed + 5);
  SceneMaker maker(seed, {chairAt(layout.uniform(3.5, 5), layout.uniform(-.6, .6))});
  const double drive = layout.uniform(-.04, .04);
  std::vector<std::pair<RoomObject, int>> alarms;  // what seems to be there, until which frame
  for (int f = 0; f < 20; ++f) {
    maker.look(drive * f, 0, 0);
    if (maker.random.uniform(0, 1) < .35)
      alarms.emplace_back(
          chairAt(maker.random.uniform(3, 5), (maker.random.index(2) ? 1 : -1) * maker.random.uniform(1, 2)),
          f + maker.random.index(3));
    const auto weakly = [&] { return maker.random.uniform(.12, .26); };
    maker.detect(0, maker.boxOf(0), weakly());
    maker.proposeTrue(0, maker.random.uniform(.1, .5));
    maker.track();
    std::erase_if(alarms, [&](const auto& alarm) { return alarm.second < f; });
    for (const auto& [object, until] : alarms) {
      const Pose3 pose = maker.scene.back().context.world_from_camera.inverse() * object.world_from_object;
      maker.detect(-1, maker.areaOf(object.shape, pose), weakly());
      maker.propose(false, object.shape, pose, maker.random.uniform(.1, .5));
    }
  }
  return maker.scene;
}

Scene jerkyRow(unsigned seed) {
  Random layout(seed + 6);
  const double spacing = layout.uniform(.7, .85), range = layout.uniform(2.8, 3.5);
  std::vector<RoomObject> row;
  for (int k = 0; k < 4; ++k) row.push_back(chairAt(range, spacing * (k - 1.5)));
  SceneMaker maker(seed, row);
  for (int f = 0; f < 15; ++f) {
    const bool jerk = maker.random.uniform(0, 1) < .2;
    const double half_spacing = .5 * spacing / range;
    maker.look(0, 0, 0,
               jerk ? (maker.random.index(2) ? 1 : -1) * maker.random.uniform(.6, 1.1) * half_spacing : 0);
    for (int k = 0; k < 4; ++k) {
      maker.detect(k, maker.boxOf(k), .9);
      maker.proposeTrue(k, .8);
    }
    maker.track();
  }
  return maker.scene;
}

namespace {

// Adds what was selected of a frame. `tracks`: the last track of every object.
void count(const SceneFrame& frame, const std::vector<ObjectMeasurement>& selected,
           std::map<int, TrackId>& tracks, SceneCounts& counts) {
  std::vector<const ObjectMeasurement*> chosen(frame.objects.size(), nullptr);
  for (const auto& measurement : selected)
    chosen[static_cast<std::size_t>(measurement.proposal.detection)] = &measurement;
  for (std::size_t j = 0; j < frame.objects.size(); ++j) {
    const int object = frame.objects[j];
    if (object < 0) {
      const bool proposed =
          std::any_of(frame.proposals.proposals.begin(), frame.proposals.proposals.end(),
                      [&](const Proposal& p) { return p.detection == static_cast<int>(j); });
      counts.false_alarms += proposed;
      counts.false_selected += chosen[j] != nullptr;
      continue;
    }
    ++counts.detections;
    if (!chosen[j]) continue;
    const bool right = chosen[j]->proposal.source == "right";
    ++(right ? counts.right : counts.wrong);
    counts.squared_errors += std::pow(chosen[j]->confidence - right, 2);
    const auto before = tracks.find(object);
    if (before != tracks.end()) {
      ++counts.links;
      counts.kept += before->second == chosen[j]->track && chosen[j]->track.value >= 0;
    }
    tracks[object] = chosen[j]->track;
  }
}

}  // namespace

SceneCounts countOver(Scene (*scene)(unsigned), const std::string& selector, const std::string& keys,
                      unsigned first_seed, unsigned seeds) {
  selection::registerClasses();
  SceneCounts counts;
  for (unsigned seed = first_seed; seed < first_seed + seeds; ++seed) {
    const auto stage = createStage<ProposalSelector>(selector, "selection");
    Config::fromText("[selection]\n" + keys).read("selection", *stage);
    std::map<int, TrackId> tracks;
    for (const auto& frame : scene(seed))
      count(frame, stage->select(frame.proposals, frame.context), tracks, counts);
  }
  return counts;
}

}  // namespace roomgraph::test
