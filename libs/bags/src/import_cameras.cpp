// SPDX-License-Identifier: BSD-3-Clause
// Camera models of the chosen images, and what speaks for or against registered depth.
#include <cmath>
#include <cstdio>

#include "import_plan.h"

namespace roomgraph::bags {
namespace {

const char* const kGiveCamera = "; --camera says what it is";

std::optional<CameraModel> modelOf(const Survey& survey, std::optional<std::size_t> image,
                                   std::optional<std::size_t> info, std::vector<std::string>& warnings) {
  if (!image || !info) return std::nullopt;
  const auto& source = survey.topics[*info];
  try {
    if (!source.info) throw BadMessage("no message of it can be read");
    return cameraModel(*source.info, namedRectified(survey.topics[*image].topic.name));
  } catch (const BadMessage& error) {
    warnings.push_back(source.topic.name + ": " + error.what());
    return std::nullopt;
  }
}

bool sameSize(const ImageHead& a, const ImageHead& b) {
  return a.width == b.width && a.height == b.height;  // 0 of compressed images
}

// A camera given by the user stands for both, and its size may be left to the images.
void takeGiven(const Survey& survey, const PinholeCamera& camera, ImportPlan& plan) {
  CameraModel model{camera, {}, {}};
  const auto& choice = plan.choice;
  for (const auto topic : {choice.color, choice.depth})
    if (topic && model.camera.width == 0) {
      model.camera.width = static_cast<int>(survey.topics[*topic].image.width);
      model.camera.height = static_cast<int>(survey.topics[*topic].image.height);
    }
  if (choice.color) plan.color = model;
  if (choice.depth) plan.depth = model;
}

std::string text(const PinholeCamera& camera) {
  char out[160];
  std::snprintf(out, sizeof out, "%dx%d fx %.1f fy %.1f cx %.1f cy %.1f", camera.width, camera.height,
                camera.fx, camera.fy, camera.cx, camera.cy);
  return out;
}

bool alike(const PinholeCamera& a, const PinholeCamera& b) {
  const double scale = static_cast<double>(b.width) / a.width;
  const auto close = [&](double x, double y) { return std::abs(scale * x - y) < 0.01 * b.fx; };
  return close(a.fx, b.fx) && close(a.fy, b.fy) && close(a.cx, b.cx) && close(a.cy, b.cy);
}

// Depth without camera_info has the camera of the colour image when their frames agree, and conversely.
void lendModels(const Survey& survey, ImportPlan& plan) {
  const auto& color = survey.topics[*plan.choice.color];
  const auto& depth = survey.topics[*plan.choice.depth];
  const bool one_camera = color.frame == depth.frame && sameSize(color.image, depth.image);
  if (plan.color && !plan.depth) {
    plan.depth = plan.color;
    plan.warnings.push_back(depth.topic.name +
                            ": no camera_info; the depth is taken as registered to the colour image" +
                            (one_camera ? "" : ", though frame or size differ"));
  } else if (plan.depth && !plan.color && one_camera) {
    plan.color = plan.depth;
    plan.warnings.push_back(color.topic.name +
                            ": no camera_info; that of the depth image, which has the same frame, is taken");
  }
}

void checkRegistration(const Survey& survey, ImportPlan& plan) {
  const auto& color = survey.topics[*plan.choice.color];
  const auto& depth = survey.topics[*plan.choice.depth];
  const bool same_frame = color.frame == depth.frame;
  const auto way = survey.frames.way(color.frame, depth.frame);
  const bool named = depth.topic.name.find("registered") != std::string::npos ||
                     depth.topic.name.find("aligned") != std::string::npos;
  plan.depth_frame = depth.frame;
  if (same_frame && !alike(plan.depth->camera, plan.color->camera)) {
    plan.warnings.push_back("registration: depth has the frame of the colour image but another camera (" +
                            text(plan.depth->camera) + " against " + text(plan.color->camera) +
                            "); it is projected into the colour image with both");
  } else if (!same_frame && named) {
    plan.depth_frame = color.frame;
    plan.warnings.push_back("registration: " + depth.topic.name +
                            " is registered to colour by its name, but has frame '" + depth.frame +
                            "' instead of '" + color.frame + "'; taken as registered");
  } else if (!same_frame && !way) {
    plan.depth_frame = color.frame;
    plan.warnings.push_back("registration: no transform between the frames of depth ('" + depth.frame +
                            "') and colour ('" + color.frame + "'); both are taken to be in one place");
  } else if (!same_frame) {
    plan.warnings.push_back("registration: depth is not registered to colour (frames '" + depth.frame +
                            "' and '" + color.frame + "'); it is projected into the colour image by tf");
  }
}

}  // namespace

void planCameras(const Survey& survey, const BagImportOptions& options, ImportPlan& plan) {
  const auto& choice = plan.choice;
  if (options.camera) {
    takeGiven(survey, *options.camera, plan);
  } else {
    plan.color = modelOf(survey, choice.color, choice.color_info, plan.warnings);
    plan.depth = modelOf(survey, choice.depth, choice.depth_info, plan.warnings);
    if (choice.color && choice.depth) lendModels(survey, plan);
  }
  for (const auto& [topic, model] :
       {std::pair(choice.color, &plan.color), std::pair(choice.depth, &plan.depth)})
    if (topic && !*model)
      plan.warnings.push_back(survey.topics[*topic].topic.name +
                              ": images are left out: no usable camera_info" + kGiveCamera);
  if (choice.depth) plan.depth_frame = survey.topics[*choice.depth].frame;
  if (plan.color && plan.depth) checkRegistration(survey, plan);
}

}  // namespace roomgraph::bags
