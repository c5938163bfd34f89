// SPDX-License-Identifier: BSD-3-Clause
// CrfSelector in a synthetic room: tracks over missed, crossing and mislabelled detections.
#include "crf_selector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "best_score_selector.h"
#include "made_up_room.h"
#include "potentials.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/selection/register_classes.h"
#include "unary_selector.h"

namespace roomgraph::test {
namespace {

void configure(Configurable& stage, const std::string& keys) {
  Config::fromText("[selection]\n" + keys).read("selection", stage);
}

/// A CrfSelector that looks at a made-up room and remembers which track every object had in every frame.
struct Watcher {
  explicit Watcher(const std::string& keys = "") { configure(selector, keys); }

  /// `hidden`: objects that the detector misses in this frame. Returns track by object.
  std::map<int, TrackId> look(FrameContext context, const std::vector<RoomObject>& objects,
                              const std::set<int>& hidden = {}) {
    std::vector<RoomObject> seen;
    std::vector<int> original, numbers;
    for (int k = 0; k < static_cast<int>(objects.size()); ++k)
      if (!hidden.contains(k)) {
        seen.push_back(objects[static_cast<std::size_t>(k)]);
        original.push_back(k);
      }
    const FrameProposals frame = seenFrom(context, seen, 4, 0.1, random, &numbers);
    last = selector.select(frame, context);
    std::map<int, TrackId> tracks;
    for (const auto& measurement : last) {
      const auto j = static_cast<std::size_t>(measurement.proposal.detection);
      tracks[original[static_cast<std::size_t>(numbers[j])]] = measurement.track;
    }
    return tracks;
  }

  CrfSelector selector;
  Random random{9};
  std::vector<ObjectMeasurement> last;
};

TEST(CrfSelector, KeepsTracksApartWhenChairsChangeOrderInTheImage) {
  const std::vector<RoomObject> chairs = {chairAt(0.5, 0), chairAt(-0.5, 0)};
  Watcher watcher;
  std::map<int, TrackId> first;
  bool left_first = false, right_first = false;
  for (double angle = 1.0; angle >= -1.0; angle -= 0.1) {
    const auto tracks =
        watcher.look(viewFrom(4 * std::cos(angle), 4 * std::sin(angle), angle + M_PI), chairs);
    ASSERT_EQ(tracks.size(), 2u);
    if (first.empty()) first = tracks;
    EXPECT_EQ(tracks, first) << "at " << angle;
    const double u0 = watcher.last[0].detection.box.center().x();
    const double u1 = watcher.last[1].detection.box.center().x();
    (u0 < u1 ? left_first : right_first) = true;
  }
  EXPECT_TRUE(left_first && right_first) << "they did change order";
  EXPECT_NE(first.at(0), first.at(1));
}

TEST(CrfSelector, TracksSurviveMissedDetectionsInsideTheWindow) {
  const std::vector<RoomObject> chairs = {chairAt(3, 0.6), chairAt(3, -0.6)};
  Watcher watcher("window_frames = 4");
  int frame = 0;
  const auto look = [&](const std::set<int>& hidden) {
    ++frame;
    return watcher.look(viewFrom(0.05 * frame, 0, 0.03 * frame), chairs, hidden);
  };
  const auto first = look({});
  EXPECT_EQ(look({}), first);
  look({0});
  look({0});
  EXPECT_EQ(look({}), first) << "missed twice";
  EXPECT_EQ(look({1}).at(0), first.at(0));
  EXPECT_EQ(look({}), first) << "the other one missed";
  for (int i = 0; i < 4; ++i) EXPECT_EQ(look({0}).at(1), first.at(1));
  const auto later = look({});
  EXPECT_EQ(later.at(1), first.at(1));
  EXPECT_GT(later.at(0), std::max(first.at(0), first.at(1))) << "missed for a window: new, never an old id";
}

TEST(CrfSelector, AWrongLabelInOneFrameDoesNotBreakTheTrack) {
  std::vector<RoomObject> objects = {chairAt(3, 0.6), chairAt(3, -0.6)};
  Watcher watcher;
  const auto first = watcher.look(viewFrom(0, 0, 0), objects);
  EXPECT_EQ(watcher.last[0].beta, 1);
  objects[0].class_name = "sofa";
  const auto wrong = watcher.look(viewFrom(0.05, 0, 0), objects);
  EXPECT_EQ(wrong.at(1), first.at(1));
  EXPECT_GT(wrong.at(0), first.at(1));
  EXPECT_DOUBLE_EQ(watcher.last[0].beta, 1.0 / 3);
  objects[0].class_name = "swivel_chair";
  EXPECT_EQ(watcher.look(viewFrom(0.1, 0, 0), objects), first);
}

// Every step moves the boxes by about 90 px; each chair is about 110 px wide and 130 px from the next.
TEST(CrfSelector, FollowsATurningCamera) {
  std::vector<RoomObject> chairs;
  for (int k = 0; k < 5; ++k) chairs.push_back(chairAt(3, 0.75 * (k - 2)));
  for (const double sign : {1.0, -1.0}) {
    Watcher watcher;
    std::map<int, TrackId> tracks;
    for (double yaw = -0.8; yaw <= 0.8; yaw += 0.17) {
      for (const auto& [object, track] : watcher.look(viewFrom(0, 0, sign * yaw), chairs)) {
        if (!tracks.contains(object)) tracks[object] = track;
        EXPECT_EQ(track, tracks[object]) << "object " << object << " at " << yaw;
      }
    }
    std::set<TrackId> distinct;
    for (const auto& [object, track] : tracks) distinct.insert(track);
    EXPECT_EQ(tracks.size(), 5u);
    EXPECT_EQ(distinct.size(), 5u);
  }
}

// One chair leaves the image while another of its kind comes in: by the codes alone they are the same.
TEST(CrfSelector, AnObjectThatLeftTheImageIsNotContinuedByAnother) {
  const std::vector<RoomObject> chairs = {chairAt(3, 0), chairAt(-3, 0)};
  Watcher watcher;
  const auto first = watcher.look(viewFrom(0, 0, 0), chairs);
  const auto other = watcher.look(viewFrom(0, 0, M_PI), chairs);
  ASSERT_EQ(first.size(), 1u);
  ASSERT_EQ(other.size(), 1u);
  EXPECT_EQ(watcher.last[0].beta, 1) << "both codes read: chair";
  EXPECT_NE(first.at(0), other.at(1));
  EXPECT_EQ(watcher.look(viewFrom(0, 0, 0), chairs), first) << "back within the window";
  EXPECT_EQ(watcher.look(viewFrom(0, 0, M_PI), chairs), other);
}

// What the camera sees in a random room with a jumping camera, and the same through both selectors.
struct Compared {
  std::vector<ObjectMeasurement> crf, unary;
};
Compared compare(CrfSelector& crf, UnarySelector& unary, Random& random, bool features) {
  std::vector<RoomObject> objects;
  for (int k = 0; k < 4; ++k)
    objects.push_back(random.index(2) ? chairAt(random.uniform(2, 4), random.uniform(-1.5, 1.5))
                                      : sofaAt(random.uniform(2, 4), random.uniform(-1.5, 1.5), 1));
  FrameContext context = viewFrom(random.uniform(-.1, .1), random.uniform(-.1, .1), random.uniform(-.1, .1));
  FrameProposals frame = seenFrom(context, objects, random.index(5), 0.4, random);
  for (auto& detection : frame.detections) detection.score = random.uniform(0.1, 1);
  if (!features) context.features.clear();
  return {crf.select(frame, context), unary.select(frame, context)};
}

TEST(CrfSelector, IsTheUnarySelectorWithoutFeatures) {
  Random random(21);
  CrfSelector crf;
  UnarySelector unary;
  configure(crf, "window_frames = 100");  // the high-order term binds after that many
  std::size_t selected = 0;
  for (int round = 0; round < 90; ++round) {
    const Compared out = compare(crf, unary, random, false);
    ASSERT_EQ(out.crf.size(), out.unary.size());
    selected += out.crf.size();
    for (std::size_t k = 0; k < out.crf.size(); ++k) {
      EXPECT_EQ(out.crf[k].proposal.detection, out.unary[k].proposal.detection);
      EXPECT_EQ(out.crf[k].proposal.projected.full, out.unary[k].proposal.projected.full);
      EXPECT_DOUBLE_EQ(out.crf[k].energy.unary, out.unary[k].energy.unary);
      EXPECT_EQ(out.crf[k].energy.pairwise, 0);
      EXPECT_NEAR(out.crf[k].confidence, out.unary[k].confidence, 1e-9);
    }
  }
  EXPECT_GT(selected, 100u);
}

TEST(CrfSelector, BadLinksNeverCostAnObject) {
  Random random(22);
  CrfSelector crf;
  UnarySelector unary;
  std::size_t penalised = 0;
  for (int round = 0; round < 200; ++round) {
    const Compared out = compare(crf, unary, random, true);
    ASSERT_EQ(out.crf.size(), out.unary.size()) << "round " << round;
    for (std::size_t k = 0; k < out.crf.size(); ++k) {
      EXPECT_EQ(out.crf[k].proposal.detection, out.unary[k].proposal.detection);
      EXPECT_LE(out.crf[k].energy.unary, -0.15);
      EXPECT_GT(out.crf[k].confidence, 0);
      EXPECT_LE(out.crf[k].confidence, 1 + 1e-12);
      penalised += out.crf[k].energy.pairwise > 0.05;
    }
  }
  EXPECT_GT(penalised, 10u) << "the pairwise term did take part";
}

// Two proposals that fit their box alike, one where the object was before and one nearer and smaller: the
// frame alone prefers the wrong one by a little, the frames before know better.
TEST(CrfSelector, FormerFramesDecideBetweenLikeProposals) {
  const std::vector<RoomObject> chair = {chairAt(3, 0)};
  Random random(2);
  CrfSelector crf;
  UnarySelector unary;
  for (int f = 0; f < 3; ++f) {
    FrameContext context = viewFrom(0, 0, 0);
    crf.select(seenFrom(context, chair, 1, 0, random), context);
  }
  // A sofa comes into view: the codes differ, beta = 1/2.
  FrameContext context = viewFrom(0, 0, 0);
  FrameProposals frame = seenFrom(context, {chair[0], sofaAt(4, 1.5, 0)}, 1, 0, random);
  Proposal wrong = frame.proposals[0];
  wrong.projected.full.v_min += 40;
  wrong.projected.full.v_max += 40;
  frame.proposals[0].box_iou = 0.7;
  wrong.box_iou = 0.9;
  wrong.score = frame.proposals[0].score = 1;
  wrong.source = "wrong";
  frame.proposals.push_back(wrong);
  const auto alone = unary.select(frame, context)[0];
  EXPECT_EQ(alone.proposal.source, "wrong");
  EXPECT_EQ(alone.features.size(), 12u);
  const auto chosen = crf.select(frame, context)[0];
  EXPECT_EQ(chosen.proposal.source, "");
  EXPECT_EQ(chosen.beta, 0.5);
  EXPECT_NEAR(chosen.energy.pairwise, 0, 1e-9);
  EXPECT_EQ(chosen.features.size(), 12u);
  EXPECT_GT(chosen.confidence, 1 - alone.confidence);  // it gained from the frames before
}

// One proposal for the chair, 40 px below where it is: P = 1 - IoU with its former area. All features are common.
struct Displaced {
  FrameContext context = viewFrom(0, 0, 0);
  FrameProposals frame;
  double potential = 0;

  Displaced(const std::vector<RoomObject>& objects, Random& random) {
    frame = seenFrom(context, objects, 1, 0, random);
    Box2& area = frame.proposals[0].projected.full;
    const Box2 before = area;
    area.v_min += 40;
    area.v_max += 40;
    potential = 1 - iou(area, before);
  }
};

TEST(CrfSelector, ALinkCostsAsMuchAsTheFramesDiffer) {
  const RoomObject chair = chairAt(3, 0), sofa = sofaAt(4, 1.5, 0);
  for (const auto& [sofa_comes, constant] : {std::pair(false, 0.0), {true, 0.0}, {false, 0.4}, {true, 1.0}}) {
    CrfSelector crf;
    configure(crf, "link_weight = " + std::to_string(constant));
    Random random(2);
    FrameContext first = viewFrom(0, 0, 0);
    crf.select(seenFrom(first, {chair}, 1, 0, random), first);
    const Displaced now(sofa_comes ? std::vector{chair, sofa} : std::vector{chair}, random);
    ASSERT_GT(now.potential, 0.2);
    const auto chosen = crf.select(now.frame, now.context);
    ASSERT_FALSE(chosen.empty());
    EXPECT_NEAR(chosen[0].energy.pairwise, (constant + (sofa_comes ? 0.5 : 0)) * now.potential, 1e-9)
        << "beta is " << (sofa_comes ? "1/2" : "1");
  }
}

// The chair was not detected in the frame before, which therefore differs; the window as a whole does not.
TEST(CrfSelector, AcrossAGapTheWindowIsComparedNotTheFrameBefore) {
  const RoomObject chair = chairAt(3, 0), sofa = sofaAt(4, 1.5, 0);
  CrfSelector crf;
  configure(crf, "link_weight = 0");
  Random random(2);
  for (const std::vector<RoomObject>& seen : {std::vector{chair}, std::vector{sofa}}) {
    FrameContext context = viewFrom(0, 0, 0);
    crf.select(seenFrom(context, seen, 1, 0, random), context);
  }
  const Displaced now({chair, sofa}, random);
  const auto chosen = crf.select(now.frame, now.context);
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].beta, 0.5);
  EXPECT_EQ(chosen[0].track, TrackId{0});
  EXPECT_NEAR(chosen[0].energy.pairwise, 0, 1e-9) << "beta* is 1";
}

// Without common features frames are independent, so two frames of one proposal each have four choices; in a whole
// window the one in which the object never appears is not among them.
TEST(CrfSelector, InAWholeWindowTheObjectWasSeenForSure) {
  constexpr double kTemperature = 0.5;
  for (const bool whole : {false, true}) {
    CrfSelector crf;
    configure(crf, std::string("temperature = 0.5\nwindow_frames = ") + (whole ? "2" : "3"));
    Random random(5);
    std::vector<double> weights;
    double confidence = 0;
    for (int f = 0; f < 2; ++f) {
      FrameContext context = viewFrom(0, 0, 0);
      const FrameProposals frame = seenFrom(context, {chairAt(3, 0)}, 1, 0, random);
      context.features.clear();
      const auto chosen = crf.select(frame, context);
      ASSERT_EQ(chosen.size(), 1u);
      weights.push_back(std::exp(-chosen[0].energy.unary / kTemperature));
      confidence = chosen[0].confidence;
    }
    const double newest = weights[1] * (1 + weights[0]), all = (1 + weights[0]) * (1 + weights[1]);
    EXPECT_NEAR(confidence, newest / (whole ? all - 1 : all), 1e-12) << whole;
  }
}

// An energy of -.15 at most is asked for, and no frame reaches it: "at least once" asks for one of the
// window.
TEST(CrfSelector, WhereNoneCompetesAWeakObjectIsSelectedOnceFollowedForAWindow) {
  for (const bool competes : {false, true}) {
    CrfSelector crf;
    configure(crf, std::string("window_frames = 3\nnone_competes = ") + (competes ? "true" : "false"));
    Random random(5);
    std::vector<std::size_t> selected;
    for (int f = 0; f < 4; ++f) {
      FrameContext context = viewFrom(0, 0, 0);
      FrameProposals frame = seenFrom(context, {chairAt(3, 0)}, 1, 0, random);
      frame.detections[0].score = 0.14;
      const auto chosen = crf.select(frame, context);
      selected.push_back(chosen.size());
      for (const auto& measurement : chosen) EXPECT_GT(measurement.energy.unary, -0.15);
    }
    EXPECT_EQ(selected, competes ? (std::vector<std::size_t>{0, 0, 1, 1}) : std::vector<std::size_t>(4, 0));
  }
}

TEST(CrfSelector, CopesWithFramesWithoutDetectionsOrProposals) {
  CrfSelector selector;
  Random random(4);
  const std::vector<RoomObject> chair = {chairAt(3, 0)};
  FrameContext context = viewFrom(0, 0, 0);
  EXPECT_TRUE(selector.select({}, context).empty());
  EXPECT_TRUE(selector.select(seenFrom(context, chair, 0, 0, random), context).empty());
  const auto seen = selector.select(seenFrom(context, chair, 1, 0, random), context);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].track, TrackId{0}) << "counted from the detection without proposals";
  EXPECT_TRUE(selector.select({}, context).empty());
  // Without proposals the box turns with the camera.
  for (const double yaw : {0.0, 0.15, 0.3, 0.45}) {
    FrameContext turned = viewFrom(0, 0, yaw);
    selector.select(seenFrom(turned, chair, 0, 0, random), turned);
  }
  FrameContext turned = viewFrom(0, 0, 0.5);
  EXPECT_EQ(selector.select(seenFrom(turned, chair, 1, 0, random), turned).at(0).track, TrackId{0});
}

TEST(BestScoreSelector, TakesTheBestScoreWhateverItsEnergy) {
  FrameContext context = viewFrom(0, 0, 0);
  Random random(4);
  FrameProposals frame = seenFrom(context, {chairAt(3, 0)}, 3, 0.3, random);
  ASSERT_EQ(frame.proposals.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) frame.proposals[i].score = i == 1 ? 0.9 : 0.5;
  frame.proposals[1].box_iou = 0.01;
  frame.detections.push_back(frame.detections[0]);  // without proposals
  BestScoreSelector selector;
  const auto chosen = selector.select(frame, context);
  ASSERT_EQ(chosen.size(), 1u);
  EXPECT_EQ(chosen[0].proposal.score, 0.9);
  EXPECT_EQ(chosen[0].confidence, 1);
  EXPECT_FALSE(chosen[0].features.empty());
}

TEST(Selectors, AreMadeByName) {
  selection::registerClasses();
  for (const char* name : {"BestScoreSelector", "UnarySelector", "CrfSelector"})
    EXPECT_TRUE(createStage<ProposalSelector>(name, "test")) << name;
}

}  // namespace
}  // namespace roomgraph::test
