// SPDX-License-Identifier: BSD-3-Clause
// Choice of the robot's frame, labels, and where ground truth and odometry come from.
#include "import_plan.h"

#include <algorithm>
#include <set>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph::bags {
namespace {

std::string odometryFrame(const Survey& survey, const TopicChoice& choice) {
  return choice.odometry ? survey.topics[*choice.odometry].frame : "odom";
}

std::string robotFrame(const Survey& survey, const TopicChoice& choice, const BagImportOptions& options) {
  const auto& frames = survey.frames;
  if (!options.base_frame.empty()) {
    if (!frames.has(options.base_frame))
      throw ConfigError("--base " + options.base_frame + ": tf has no such frame" +
                        didYouMean(options.base_frame, frames.frames()) +
                        "; there is: " + join(frames.frames()));
    return options.base_frame;
  }
  // On the floor (REP 120), where this program's robots have their origin.
  if (frames.has("base_footprint")) return "base_footprint";
  if (choice.odometry && !survey.topics[*choice.odometry].child_frame.empty())
    return survey.topics[*choice.odometry].child_frame;
  return frames.has("base_link") ? "base_link" : "";
}

void addLabels(const Survey& survey, ImportPlan& plan) {
  std::set<std::string> taken;
  const auto add = [&](std::size_t topic, const std::string& wanted) {
    std::string label = wanted;
    if (taken.contains(label)) {  // two sensors in one frame
      std::string name = survey.topics[topic].topic.name;
      std::replace(name.begin(), name.end(), '/', '_');
      label += name;
    }
    taken.insert(label);
    plan.labels[topic] = label;
  };
  const auto named = [&](std::size_t topic, const char* fallback) {
    const auto label = labelOfFrame(survey.topics[topic].frame);
    return label.empty() ? std::string(fallback) : label;
  };
  const auto& choice = plan.choice;
  if (choice.color)
    add(*choice.color, named(*choice.color, "RGBD"));
  else if (choice.depth)
    add(*choice.depth, named(*choice.depth, "RGBD"));
  for (const auto scan : choice.scans) add(scan, named(scan, "LASER"));
  if (choice.odometry) add(*choice.odometry, "ODOMETRY");
  for (const auto imu : choice.imus) add(imu, named(imu, "IMU"));
}

// The way, and the edge that gives the times; nothing when the frames are not connected or do not move.
std::optional<TfTrack> trackOf(const FrameGraph& frames, const std::string& to, const std::string& from) {
  const auto way = frames.way(to, from);
  const auto edge = way ? frames.movingEdge(*way) : std::nullopt;
  if (!edge) return std::nullopt;
  return TfTrack{*way, *edge};
}

TruthPlan truthFromTf(const FrameGraph& frames, const std::string& world, const std::string& body) {
  const auto track = trackOf(frames, world, body);
  if (!track) return {};
  return {"tf " + world + " -> " + body, track, std::nullopt, {}};
}

bool tellsPoses(const SurveyedTopic& topic) {
  return topic.looked_at && (topic.type == TopicType::kOdometry || topic.type == TopicType::kPose);
}

TruthPlan truthAskedFor(const Survey& survey, const std::string& name, const std::string& body) {
  if (name == "none") return {};
  if (const auto topic = findTopic(survey, name)) {
    if (!tellsPoses(survey.topics[*topic]))
      throw ConfigError("--truth " + name + ": is of type " + survey.topics[*topic].topic.type +
                        ", not nav_msgs/Odometry or geometry_msgs/PoseStamped");
    return {name, std::nullopt, topic, {}};
  }
  auto truth = truthFromTf(survey.frames, name, body);
  if (truth.name.empty())
    throw ConfigError("--truth " + name + ": neither a topic nor a frame of tf in which '" + body +
                      "' moves; frames: " + join(survey.frames.frames()));
  return truth;
}

TruthPlan findTruth(const Survey& survey, const TopicChoice& choice, const std::string& body) {
  for (std::size_t i = 0; i < survey.topics.size(); ++i)
    if (tellsPoses(survey.topics[i]) && choice.odometry != i && namedTruth(survey.topics[i].topic.name))
      return {survey.topics[i].topic.name, std::nullopt, i, {}};
  const auto& frames = survey.frames;
  std::vector<std::string> worlds;
  for (const auto& frame : frames.frames())
    if (namedTruth(frame)) worlds.push_back(frame);
  worlds.insert(worlds.end(), {"world", "map"});
  const auto odometry = trackOf(frames, odometryFrame(survey, choice), body);
  for (const auto& world : worlds) {
    auto truth = truthFromTf(frames, world, body);
    if (truth.name.empty()) continue;
    // A world in which only the odometry moves knows no more than that.
    const auto same = [&](const FrameGraph::Step& step) {
      return frames.fixed({step}) ||
             (odometry && std::any_of(odometry->way.begin(), odometry->way.end(),
                                      [&](const auto& other) { return other.edge == step.edge; }));
    };
    if (!std::all_of(truth.track->way.begin(), truth.track->way.end(), same)) return truth;
  }
  return {};
}

// The frame whose poses a topic tells, when they have to be turned into those of `body`.
std::string otherFrame(const Survey& survey, std::size_t topic, const std::string& what,
                       const std::string& body, std::vector<std::string>& warnings) {
  const std::string& frame = survey.topics[topic].child_frame;
  if (frame.empty() || body.empty() || frame == body) return "";
  if (survey.frames.way(frame, body)) return frame;
  warnings.push_back(survey.topics[topic].topic.name + ": " + what + " is of '" + frame +
                     "', the robot is '" + body + "': no transform between them; taken as that of the robot");
  return "";
}

void planTruth(const Survey& survey, const BagImportOptions& options, ImportPlan& plan) {
  const std::string& body = plan.robot.empty() ? plan.handheld : plan.robot;
  plan.truth = options.truth.empty() ? findTruth(survey, plan.choice, body)
                                     : truthAskedFor(survey, options.truth, body);
  if (plan.truth.topic)
    plan.truth.frame = otherFrame(survey, *plan.truth.topic, "ground truth", body, plan.warnings);
  if (options.truth.empty() && plan.truth.name.starts_with("tf map "))
    plan.warnings.push_back(
        plan.truth.name +
        " is taken as ground truth; if it is another program's estimate, --truth none leaves it out");
}

void requireSomething(const Survey& survey, const ImportPlan& plan, const std::string& bag) {
  const auto& choice = plan.choice;
  if (plan.color || plan.depth || choice.odometry || plan.odometry || !choice.scans.empty() ||
      !choice.imus.empty())
    return;
  std::vector<std::string> names;
  for (const auto& topic : survey.topics) names.push_back(topic.topic.name + " (" + topic.topic.type + ")");
  for (const auto* list : {&survey.problems, &plan.warnings})
    if (!list->empty()) throw InputError(bag + ": nothing in it can be imported; " + list->front());
  throw InputError(bag +
                   ": nothing in it can be imported; topics: " + (names.empty() ? "none" : join(names)));
}

}  // namespace

ImportPlan planImport(const Survey& survey, const BagImportOptions& options, const std::string& bag) {
  ImportPlan plan;
  plan.choice = chooseTopics(survey, options.topics);
  plan.warnings = plan.choice.warnings;
  plan.robot = robotFrame(survey, plan.choice, options);
  if (const auto camera = plan.choice.color ? plan.choice.color : plan.choice.depth;
      camera && plan.robot.empty())
    plan.handheld = survey.topics[*camera].frame;
  addLabels(survey, plan);
  if (plan.choice.odometry)
    plan.odometry_frame = otherFrame(survey, *plan.choice.odometry, "odometry", plan.robot, plan.warnings);
  planTimes(survey, options, plan);
  planCameras(survey, options, plan);
  if (plan.choice.tf) {
    planTruth(survey, options, plan);
    if (!plan.choice.odometry && !plan.robot.empty())
      plan.odometry = trackOf(survey.frames, "odom", plan.robot);
    for (const auto& frame : survey.frames.disputed())
      plan.warnings.push_back("tf: frame '" + frame + "' has several parents; the shortest way is taken");
  } else if (!options.truth.empty()) {
    planTruth(survey, options, plan);
  }
  for (const auto& topic : survey.topics)
    if (topic.broken > 0 && topic.broken == topic.count)
      plan.warnings.push_back(topic.topic.name + ": no message can be read (" + topic.fault + ")");
  requireSomething(survey, plan, bag);
  return plan;
}

}  // namespace roomgraph::bags
