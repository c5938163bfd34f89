// SPDX-License-Identifier: BSD-3-Clause
// Marks by encoding and name, the camera_info beside an image, and choices of the user.
#include "topic_choice.h"

#include <algorithm>
#include <limits>

#include "image_decoding.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph::bags {
namespace {

constexpr double kUnfit = -std::numeric_limits<double>::infinity();

bool mentions(const std::string& name, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return name.find(word) != std::string::npos; });
}

bool isImage(const SurveyedTopic& topic) {
  return topic.type == TopicType::kImage || topic.type == TopicType::kCompressedImage;
}

bool isDepth(const SurveyedTopic& topic) {
  if (!isImage(topic)) return false;
  const auto& encoding = topic.image.encoding;
  const bool named = mentions(topic.topic.name, {"depth", "disparity"});
  if (encoding.find("compressedDepth") != std::string::npos) return true;
  if (encoding.starts_with("mono16")) return named;
  if (contentOf(encoding) == ImageContent::kDepth) return true;
  return topic.type == TopicType::kCompressedImage && named && encoding == "png";
}

// Folders of a name that two topics share: those of one camera share most.
double sharedFolders(const std::string& a, const std::string& b) {
  const auto differ = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
  return static_cast<double>(std::count(a.begin(), differ, '/'));
}

double markAsColor(const SurveyedTopic& topic) {
  if (!isImage(topic) || !topic.looked_at || isDepth(topic)) return kUnfit;
  const auto content = contentOf(topic.image.encoding);
  if (content != ImageContent::kColor && content != ImageContent::kGray) return kUnfit;
  const auto& name = topic.topic.name;
  double mark = content == ImageContent::kColor ? 10 : 2;
  if (mentions(name, {"rgb", "color", "colour"})) mark += 5;
  if (mentions(name, {"infra", "/ir/", "fisheye", "right", "thermal"})) mark -= 5;
  if (mentions(name, {"depth", "debug", "overlay", "result"})) mark -= 12;
  return mark + (topic.type == TopicType::kImage ? 0.5 : 0);
}

double markAsDepth(const SurveyedTopic& topic, const std::string& color) {
  if (!topic.looked_at || !isDepth(topic)) return kUnfit;
  const auto& name = topic.topic.name;
  double mark = mentions(name, {"aligned", "registered"}) ? 5 : 0;
  if (mentions(name, {"confidence", "disparity"})) mark -= 10;
  return mark + (topic.type == TopicType::kImage ? 0.5 : 0) + 0.1 * sharedFolders(name, color);
}

double markAsOdometry(const SurveyedTopic& topic) {
  const auto& name = topic.topic.name;
  // As odometry it would be better than any robot's, and nothing would be left to compare a run with.
  if (topic.type != TopicType::kOdometry || !topic.looked_at || namedTruth(name)) return kUnfit;
  double mark = name == "/odom" || name == "odom" ? 4 : name.ends_with("/odom") ? 3 : 0;
  if (mentions(name, {"wheel"})) mark += 2;
  if (mentions(name, {"visual", "filtered", "/vo"})) mark -= 2;
  return mark;
}

// The topic with the highest mark; of equal ones that with more messages.
template <class Mark>
std::optional<std::size_t> best(const Survey& survey, Mark&& mark) {
  std::optional<std::size_t> found;
  double highest = kUnfit;
  for (std::size_t i = 0; i < survey.topics.size(); ++i) {
    const double value = mark(survey.topics[i]);
    const bool more = found && value == highest && survey.topics[i].count > survey.topics[*found].count;
    if (value > highest || (more && value > kUnfit)) {
      found = i;
      highest = value;
    }
  }
  return found;
}

std::vector<std::size_t> allOf(const Survey& survey, TopicType type) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < survey.topics.size(); ++i)
    if (survey.topics[i].type == type && survey.topics[i].looked_at) found.push_back(i);
  return found;
}

// "/camera/rgb/image_raw/compressed" -> "/camera/rgb".
std::string folderOfImage(std::string name) {
  for (const char* transport : {"/compressed", "/compressedDepth"})
    if (name.ends_with(transport)) name.resize(name.size() - std::string(transport).size());
  return name.substr(0, name.rfind('/') == std::string::npos ? 0 : name.rfind('/'));
}

std::optional<std::size_t> infoBeside(const Survey& survey, const SurveyedTopic& image,
                                      std::vector<std::string>& warnings) {
  if (const auto beside = findTopic(survey, folderOfImage(image.topic.name) + "/camera_info")) return beside;
  std::vector<std::size_t> fitting;
  for (const auto i : allOf(survey, TopicType::kCameraInfo)) {
    const auto& other = survey.topics[i];
    const bool size = image.image.width == 0 || (other.info && other.info->width == image.image.width &&
                                                 other.info->height == image.image.height);
    if (other.frame == image.frame && size) fitting.push_back(i);
  }
  if (fitting.size() != 1) return std::nullopt;
  warnings.push_back(image.topic.name + ": no camera_info beside it; " +
                     survey.topics[fitting[0]].topic.name + " has its frame and size and is taken");
  return fitting[0];
}

void chooseByType(const Survey& survey, TopicChoice& choice) {
  choice.color = best(survey, markAsColor);
  const std::string color = choice.color ? survey.topics[*choice.color].topic.name : "";
  choice.depth = best(survey, [&](const SurveyedTopic& topic) { return markAsDepth(topic, color); });
  choice.odometry = best(survey, markAsOdometry);
  choice.scans = allOf(survey, TopicType::kScan);
  choice.imus = allOf(survey, TopicType::kImu);
}

std::string kindByType(const SurveyedTopic& topic) {
  switch (topic.type) {
    case TopicType::kImage:
    case TopicType::kCompressedImage:
      return isDepth(topic) ? "depth" : "color";
    case TopicType::kCameraInfo:
      return topic.topic.name.find("depth") != std::string::npos ? "depth_info" : "color_info";
    case TopicType::kScan:
      return "scan";
    case TopicType::kOdometry:
      return "odometry";
    case TopicType::kImu:
      return "imu";
    default:
      return "";
  }
}

bool fits(const SurveyedTopic& topic, const std::string& kind) {
  if (kind == "color" || kind == "depth") return isImage(topic);
  if (kind == "color_info" || kind == "depth_info") return topic.type == TopicType::kCameraInfo;
  return kindByType(topic) == kind;
}

struct AskedTopic {
  std::string kind, name;
};

AskedTopic parseAsked(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) return {"", text};
  const AskedTopic asked{text.substr(0, equals), text.substr(equals + 1)};
  const auto& kinds = bagTopicKinds();
  if (std::find(kinds.begin(), kinds.end(), asked.kind) == kinds.end())
    throw ConfigError("--topic " + text + ": no kind '" + asked.kind + "'" + didYouMean(asked.kind, kinds) +
                      "; there is: " + join(kinds));
  return asked;
}

void leaveOut(TopicChoice& choice, const std::string& kind) {
  if (kind == "color") choice.color.reset();
  if (kind == "depth") choice.depth.reset();
  if (kind == "odometry") choice.odometry.reset();
  if (kind == "scan") choice.scans.clear();
  if (kind == "imu") choice.imus.clear();
  if (kind == "tf") choice.tf = false;
}

void take(TopicChoice& choice, const std::string& kind, std::size_t topic) {
  if (kind == "color") choice.color = topic;
  if (kind == "depth") choice.depth = topic;
  if (kind == "color_info") choice.color_info = topic;
  if (kind == "depth_info") choice.depth_info = topic;
  if (kind == "odometry") choice.odometry = topic;
  if (kind == "scan") choice.scans.push_back(topic);
  if (kind == "imu") choice.imus.push_back(topic);
}

void apply(const Survey& survey, const std::vector<std::string>& asked_for, TopicChoice& choice) {
  std::vector<std::string> names, replaced;
  for (const auto& topic : survey.topics) names.push_back(topic.topic.name);
  for (const auto& text : asked_for) {
    auto asked = parseAsked(text);
    if (!asked.kind.empty() && asked.name == "none") {
      leaveOut(choice, asked.kind);
      continue;
    }
    const auto topic = findTopic(survey, asked.name);
    if (!topic)
      throw ConfigError("--topic " + text + ": no such topic in the bag" + didYouMean(asked.name, names) +
                        "; there is: " + join(names));
    const auto& found = survey.topics[*topic];
    if (asked.kind.empty()) asked.kind = kindByType(found);
    if (asked.kind.empty() || !fits(found, asked.kind))
      throw ConfigError("--topic " + text + ": a topic of type " + found.topic.type + " cannot be imported" +
                        (asked.kind.empty() ? "" : " as " + asked.kind));
    // Several may be named of one kind; together they stand for those found by type.
    if (std::find(replaced.begin(), replaced.end(), asked.kind) == replaced.end())
      leaveOut(choice, asked.kind);
    replaced.push_back(asked.kind);
    take(choice, asked.kind, *topic);
  }
}

}  // namespace

std::optional<std::size_t> findTopic(const Survey& survey, const std::string& name) {
  for (std::size_t i = 0; i < survey.topics.size(); ++i)
    if (survey.topics[i].topic.name == name) return i;
  return std::nullopt;
}

bool namedTruth(const std::string& name) {
  const auto gt = name.find("/gt");
  const bool short_name =
      gt != std::string::npos && (name.size() == gt + 3 || name[gt + 3] == '/' || name[gt + 3] == '_');
  return short_name || mentions(name, {"truth", "mocap", "vicon", "optitrack", "qualisys"});
}

bool namedRectified(const std::string& topic) {
  return topic.find("rect", topic.rfind("/image")) != std::string::npos;
}

TopicChoice chooseTopics(const Survey& survey, const std::vector<std::string>& asked_for) {
  TopicChoice choice;
  chooseByType(survey, choice);
  apply(survey, asked_for, choice);
  if (choice.color && !choice.color_info)
    choice.color_info = infoBeside(survey, survey.topics[*choice.color], choice.warnings);
  if (choice.depth && !choice.depth_info)
    choice.depth_info = infoBeside(survey, survey.topics[*choice.depth], choice.warnings);
  return choice;
}

std::string kindOf(const TopicChoice& choice, const Survey& survey, std::size_t topic) {
  const auto among = [&](const std::vector<std::size_t>& list) {
    return std::find(list.begin(), list.end(), topic) != list.end();
  };
  if (choice.color == topic) return "color";
  if (choice.depth == topic) return "depth";
  if (choice.color_info == topic) return "color_info";
  if (choice.depth_info == topic) return "depth_info";
  if (choice.odometry == topic) return "odometry";
  if (among(choice.scans)) return "scan";
  if (among(choice.imus)) return "imu";
  return choice.tf && survey.topics[topic].type == TopicType::kTransforms ? "tf" : "";
}

std::string labelOfFrame(std::string frame) {
  for (const char* ending : {"_optical_frame", "_optical", "_frame", "_link"})
    if (const std::string text = ending; frame.ends_with(text) && frame.size() > text.size())
      return frame.substr(0, frame.size() - text.size());
  return frame;
}

}  // namespace roomgraph::bags
