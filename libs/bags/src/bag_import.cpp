// SPDX-License-Identifier: BSD-3-Clause
// The two readings of a bag, and the files that come of them.
#include "roomgraph/bags/bag_import.h"

#include <algorithm>

#include "conversion.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/import_images.h"
#include "roomgraph/datasets/import_output.h"
#include "roomgraph/observations/mounting.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

constexpr double kSurveyShare = 0.3;  // of the time that both readings take

std::function<void(double)> partOf(const std::function<void(double)>& progress, double from, double to) {
  if (!progress) return nullptr;
  return [=](double share) { progress(from + (to - from) * share); };
}

ImportInputs inputsOf(const fs::path& bag) {
  const auto files = bags::filesOfBag(bag);
  return {bag, files};
}

void tellUsed(const bags::Survey& survey, const bags::ImportPlan& plan, BagImportResult& result) {
  for (const auto& kind : bagTopicKinds())
    for (std::size_t i = 0; i < survey.topics.size(); ++i)
      if (bags::kindOf(plan.choice, survey, i) == kind)
        result.used.push_back(kind + ": " + survey.topics[i].topic.name);
  if (plan.odometry) result.used.push_back("odometry: tf odom -> " + plan.robot);
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const auto& line : more)
    if (std::find(all.begin(), all.end(), line) == all.end()) all.push_back(line);
}

std::string detailOf(const bags::SurveyedTopic& topic) {
  std::string detail = topic.image.encoding;
  const auto size = [](auto width, auto height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  if (topic.image.width > 0) detail += " " + size(topic.image.width, topic.image.height);
  if (topic.info)
    detail += size(topic.info->width, topic.info->height) + (topic.info->k[0] > 0 ? "" : ", not calibrated");
  if (!topic.frame.empty()) detail += (detail.empty() ? "frame " : ", frame ") + topic.frame;
  if (!topic.child_frame.empty()) detail += " -> " + topic.child_frame;
  if (topic.broken > 0) detail += (detail.empty() ? "" : ", ") + std::to_string(topic.broken) + " broken";
  return detail;
}

}  // namespace

const std::vector<std::string>& bagTopicKinds() {
  static const std::vector<std::string> kinds{"color", "depth",    "color_info", "depth_info",
                                              "scan",  "odometry", "imu",        "tf"};
  return kinds;
}

BagContents listBag(const fs::path& bag, const std::function<void(double)>& progress) {
  const auto survey = bags::surveyBag(bag, progress);
  const auto choice = bags::chooseTopics(survey, {});
  BagContents contents{{}, survey.frames.frames(), survey.problems};
  for (std::size_t i = 0; i < survey.topics.size(); ++i) {
    const auto& topic = survey.topics[i];
    BagTopicInfo info{topic.topic.name, topic.topic.type, detailOf(topic), topic.count};
    info.first_s = 1e-9 * static_cast<double>(topic.first_ns);
    info.last_s = 1e-9 * static_cast<double>(topic.last_ns);
    if (const auto delay = topic.header_minus_received.summary())
      info.header_minus_received_s = delay->median;
    info.used_as = bags::kindOf(choice, survey, i);
    contents.topics.push_back(std::move(info));
  }
  std::sort(contents.topics.begin(), contents.topics.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return contents;
}

BagImportResult importBag(const fs::path& bag, const fs::path& rawlog, const BagImportOptions& options,
                          const std::function<void(double)>& progress) {
  const ImportPlaces places = placesOf(rawlog);
  const ImportInputs inputs = inputsOf(bag);
  checkPlaces(places, inputs, options.external_images);
  bags::Survey survey = bags::surveyBag(bag, partOf(progress, 0, kSurveyShare));
  bags::lookAtPictures(bag, survey);
  const auto plan = bags::planImport(survey, options, bag.string());
  BagImportResult result;
  append(result.warnings, survey.problems);
  append(result.warnings, plan.warnings);
  tellUsed(survey, plan, result);
  ImportOutput output(places, options.external_images);
  const EmbeddedImages embedded(options.jpeg_quality);
  bool held = plan.robot.empty();
  bags::Conversion conversion(std::move(survey), plan, options,
                              [&](mrpt::obs::CObservation& record, const std::vector<std::uint8_t>& picture) {
                                auto* images = dynamic_cast<mrpt::obs::CObservation3DRangeScan*>(&record);
                                if (images && options.external_images) storeOutside(*images, picture, output);
                                if (images) held = !isMounted(toPose3(images->sensorPose));
                                output.rawlog().write(record);
                              });
  const auto reader = bags::openBag(bag);
  reader->wants([&](const bags::BagTopic& topic) { return conversion.wants(topic); });
  const auto told = partOf(progress, kSurveyShare, 1);
  for (bags::RawMessage message; reader->next(message);) {
    conversion.take(message, reader->topics()[message.topic]);
    if (told) told(reader->progress());
  }
  conversion.finish();
  result.written = conversion.written();
  result.skipped = conversion.skipped();
  append(result.warnings, conversion.warnings());
  if (result.written.empty())
    throw InputError(bag.string() + ": no record can be made of it" +
                     (result.skipped.empty() ? "" : "; " + result.skipped.begin()->first));
  result.base_frame = plan.robot;
  if (!conversion.truth().empty()) {
    result.ground_truth = places.ground_truth;
    result.truth = plan.truth.name;
    output.setGroundTruth(conversion.truth(), held ? TruthOf::kCamera : TruthOf::kRobot);
  }
  for (const auto& removed : output.commit(inputs))
    result.warnings.push_back(removed.string() + " of the former import was removed: this one has none");
  return result;
}

}  // namespace roomgraph
