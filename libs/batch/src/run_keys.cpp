// SPDX-License-Identifier: BSD-3-Clause
// Everything that counts as text, hashed.
#include "run_keys.h"

#include "roomgraph/core/checksum.h"

namespace roomgraph {
namespace {

// One text of many, none of which can be taken for two others.
class KeyText {
 public:
  KeyText& add(const std::string& name, const std::string& value) {
    text_ += name + " " + std::to_string(value.size()) + " " + value + "\n";
    return *this;
  }
  std::string hash() const { return sha256Of(text_); }

 private:
  std::string text_;
};

// A file counts by its bytes, wherever it lies.
std::string withoutPlace(std::string value, const RunNeeds& needs, FileHashes& hashes) {
  for (const auto& file : needs.files) {
    const std::string name = file.string();
    for (auto at = value.find(name); at != std::string::npos; at = value.find(name))
      value.replace(at, name.size(), hashes.of(file));
  }
  return value;
}

}  // namespace

std::string runKey(const std::string& recording, const RunNeeds& needs, const BatchVariant& variant,
                   const std::string& program, FileHashes& hashes) {
  KeyText text;
  text.add("run", "1").add("recording", recording).add("program", program).add("objects", needs.objects);
  for (const auto& [name, value] : needs.parameters) text.add(name, withoutPlace(value, needs, hashes));
  for (const auto& pose : variant.poses) text.add("pose", pose);
  return text.add("files", hashes.of(needs.files)).hash();
}

std::string detectionKey(const std::string& recording, const RunNeeds& needs, const std::string& program,
                         FileHashes& hashes) {
  if (needs.detections.empty()) return "";
  KeyText text;
  text.add("detections", withoutPlace(needs.detections, needs, hashes))
      .add("recording", recording)
      .add("program", program);
  return text.add("objects", needs.objects).add("files", hashes.of(needs.files)).hash();
}

std::string evaluationKey(const TruthFiles& truth, const JobFile& jobs, const std::string& program,
                          FileHashes& hashes) {
  KeyText text;
  text.add("evaluation", "1").add("program", program);
  for (const auto& [kind, file] : truth) text.add(kind, hashes.of(file));
  for (const auto& [kind, words] : jobs.evaluation)
    for (const auto& word : words) text.add(kind, word);
  return text.hash();
}

std::string simulationKey(const PlannedInput& input, const std::string& simulator, FileHashes& hashes) {
  KeyText text;
  text.add("simulation", "1").add("program", simulator);
  const bool world = !input.simulate.front().starts_with("-");
  for (const auto& word : input.simulate)
    text.add("word", world && &word == &input.simulate.front() ? hashes.of(word) : word);
  return text.hash();
}

std::string whatChanged(const RunResult& before, const RunResult& now) {
  if (before.status != "complete") return before.status + " before: " + before.reason;
  if (before.input.sha256 != now.input.sha256) return "the recording has changed";
  if (before.parameters != now.parameters) {
    std::string names;
    for (const auto& [name, value] : now.parameters) {
      const auto old = before.parameters.find(name);
      if (old == before.parameters.end() || old->second != value) names += (names.empty() ? "" : ", ") + name;
    }
    return "the configuration has changed" + (names.empty() ? "" : ": " + names);
  }
  if (before.program != now.program) return "the program has changed";
  if (before.key != now.key) return "objects, networks or places of sensors have changed";
  if (before.evaluation_key != now.evaluation_key) return "the truth or the evaluation has changed";
  return before.reason.empty() ? "more is to be kept" : before.reason;
}

std::vector<EvaluationStep> evaluationSteps(const TruthFiles& truth, const std::filesystem::path& folder,
                                            const JobFile& jobs) {
  const auto path = [&truth](const char* kind) {
    const auto file = truth.find(kind);
    return file == truth.end() ? std::string() : file->second.string();
  };
  const bool robot = truth.contains("trajectory");
  const std::string way = path(robot ? "trajectory" : "camera_trajectory"), boxes = path("boxes");
  const std::string way_file = robot ? "trajectory.tum" : "trajectory_camera.tum";
  const std::string estimate = (folder / way_file).string();
  const auto aligned = [&](std::vector<std::string> words) {
    if (!way.empty()) words.insert(words.end(), {"--truth-trajectory", way, "--trajectory", estimate});
    return words;
  };
  std::vector<EvaluationStep> all;
  if (!way.empty()) all.push_back({"trajectory", {"trajectory", way, estimate}, {way_file}});
  if (robot) all.push_back({"live", {"trajectory", way, (folder / "live.tum").string()}, {"live.tum"}});
  if (truth.contains("relations"))
    all.push_back({"relations",
                   {"relations", path("relations"), (folder / "trajectory.tum").string()},
                   {"trajectory.tum"}});
  const auto objects = [&](const char* associations) {
    std::vector<std::string> words{"objects", path("objects"), (folder / "landmarks.json").string()};
    if (!boxes.empty())
      words.insert(words.end(), {"--truth-boxes", boxes, "--associations", (folder / associations).string()});
    return aligned(words);
  };
  if (truth.contains("objects")) {
    all.push_back({"objects", objects("associations.jsonl"), {"landmarks.json"}});
    if (!boxes.empty())
      all.push_back({"objects_live", objects("associations_live.jsonl"), {"associations_live.jsonl"}});
  }
  if (!boxes.empty())
    all.push_back(
        {"detections", {"detections", boxes, (folder / "detections.jsonl").string()}, {"detections.jsonl"}});
  if (truth.contains("map"))
    all.push_back({"map", aligned({"map", path("map"), (folder / "map.yaml").string()}), {"map.yaml"}});
  std::vector<EvaluationStep> out;
  for (auto& step : all) {
    const auto more = jobs.evaluation.find(step.report);
    if (more != jobs.evaluation.end()) {
      if (more->second == std::vector<std::string>{"none"}) continue;
      step.arguments.insert(step.arguments.end(), more->second.begin(), more->second.end());
    }
    out.push_back(std::move(step));
  }
  return out;
}

}  // namespace roomgraph
