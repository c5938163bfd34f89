// SPDX-License-Identifier: BSD-3-Clause
// Camera models of the chosen images, and what speaks for or against registered depth.
#include <cmath>
#include <cstdio>

#include "import_plan.h"

namespace roomgraph::bags {
namespace {

const char* const kGiveCamera = "; --camera says what it is";

// Empty where it is not known, or nothing that an image can have.
cv::Size sizeOf(const ImageHead& image) {
  constexpr std::uint32_t kWidest = 1u << 14;
  if (image.width > kWidest || image.height > kWidest) return {};
  return {static_cast<int>(image.width), static_cast<int>(image.height)};
}

std::string scaledBy(double factor) {
  char out[80];
  std::snprintf(out, sizeof out, " of another size: it is scaled by %.4g", factor);
  return out;
}

std::optional<CameraModel> modelOf(const Survey& survey, std::optional<std::size_t> image,
                                   std::optional<std::size_t> info, bool rectified,
                                   std::vector<std::string>& warnings) {
  if (!image || !info) return std::nullopt;
  const auto& source = survey.topics[*info];
  const auto& images = survey.topics[*image];
  try {
    if (!source.info) throw BadMessage("no message of it can be read");
    const auto model = cameraModel(*source.info, rectified, sizeOf(images.image));
    if (model.scale != 1)
      warnings.push_back(source.topic.name + ": the images of " + images.topic.name + " are" +
                         scaledBy(model.scale));
    return model;
  } catch (const BadMessage& error) {
    warnings.push_back(source.topic.name + ": " + error.what());
    return std::nullopt;
  }
}

bool sameSize(const ImageHead& a, const ImageHead& b) {
  return a.width == b.width && a.height == b.height;  // 0 of pictures that cannot be decoded
}

std::optional<CameraModel> givenModel(const SurveyedTopic& images, const PinholeCamera& camera,
                                      std::vector<std::string>& warnings) {
  CameraModel model;
  model.camera = camera;
  if (camera.width == 0) return model;
  try {
    model.camera = fittedTo(camera, sizeOf(images.image));
  } catch (const BadMessage& error) {
    warnings.push_back(std::string("--camera: ") + error.what());
    return std::nullopt;
  }
  model.scale = static_cast<double>(model.camera.width) / camera.width;
  if (model.scale != 1)
    warnings.push_back("--camera: the images of " + images.topic.name + " are" + scaledBy(model.scale));
  return model;
}

// A camera given by the user stands for both, and its size may be left to the images: those of colour first.
void takeGiven(const Survey& survey, PinholeCamera camera, ImportPlan& plan) {
  const auto& choice = plan.choice;
  for (const auto topic : {choice.color, choice.depth})
    if (topic && camera.width == 0) {
      const auto size = sizeOf(survey.topics[*topic].image);
      camera.width = size.width;
      camera.height = size.height;
    }
  if (choice.color) plan.color = givenModel(survey.topics[*choice.color], camera, plan.warnings);
  if (choice.depth) plan.depth = givenModel(survey.topics[*choice.depth], camera, plan.warnings);
}

std::string text(const PinholeCamera& camera) {
  char out[160];
  std::snprintf(out, sizeof out, "%dx%d fx %.1f fy %.1f cx %.1f cy %.1f", camera.width, camera.height,
                camera.fx, camera.fy, camera.cx, camera.cy);
  return out;
}

bool alike(const PinholeCamera& a, const PinholeCamera& b) {
  const double scale = a.width > 0 && b.width > 0 ? static_cast<double>(b.width) / a.width : 1;
  const PinholeCamera same = a.scaled(scale);
  const auto close = [&](double x, double y) { return std::abs(x - y) < 0.01 * b.fx; };
  return close(same.fx, b.fx) && close(same.fy, b.fy) && close(same.cx, b.cx) && close(same.cy, b.cy);
}

// Depth without camera_info has the camera of the colour image when their frames agree, and conversely.
void lendModels(const Survey& survey, ImportPlan& plan) {
  const auto& color = survey.topics[*plan.choice.color];
  const auto& depth = survey.topics[*plan.choice.depth];
  const bool one_camera = color.frame == depth.frame && sameSize(color.image, depth.image);
  if (plan.color && !plan.depth) {
    plan.depth = modelOf(survey, plan.choice.depth, plan.choice.color_info, namedRectified(color.topic.name),
                         plan.warnings);
    if (!plan.depth) return;
    plan.warnings.push_back(depth.topic.name +
                            ": no usable camera_info; the depth is taken as registered to the colour image" +
                            (one_camera ? "" : ", though frame or size differ"));
  } else if (plan.depth && !plan.color && one_camera) {
    plan.color = plan.depth;
    plan.warnings.push_back(
        color.topic.name +
        ": no usable camera_info; that of the depth image, which has the same frame, is taken");
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
    const auto named = [&](std::optional<std::size_t> topic) {
      return topic && namedRectified(survey.topics[*topic].topic.name);
    };
    plan.color = modelOf(survey, choice.color, choice.color_info, named(choice.color), plan.warnings);
    plan.depth = modelOf(survey, choice.depth, choice.depth_info, named(choice.depth), plan.warnings);
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
