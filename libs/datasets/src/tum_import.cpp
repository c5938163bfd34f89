// SPDX-License-Identifier: BSD-3-Clause
// RGB-D records written from image pairs, with checks of images, stamps and camera.
#include "roomgraph/datasets/tum_import.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/datasets/import_output.h"
#include "roomgraph/observations/image_file.h"
#include "roomgraph/observations/mrpt_camera.h"
#include "tum_camera.h"
#include "tum_ground_truth.h"
#include "roomgraph/datasets/tum_lists.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;

constexpr float kMaxRangeM = 10;  // for viewers only
constexpr int kWarningsShown = 5;
const std::string kPairLeftOut = "pair left out: ";

bool load(mrpt::img::CImage& image, const fs::path& file) {
  try {
    const ImageMemoryLimit limit(fs::file_size(file));
    return image.loadFromFile(file.string());
  } catch (const std::exception&) {
    return false;
  }
}

class Writer {
 public:
  Writer(ImportOutput& output, const TumCamera& camera, const TumImportOptions& options)
      : output_(output), camera_(camera), options_(options) {}

  /// Empty, or why the pair was left out.
  std::string write(const TumPair& pair) {
    for (const auto& file : {pair.color, pair.depth})
      if (!fs::is_regular_file(file)) return "no such file: " + file.string();
    const cv::Mat depth = readImageFile(pair.depth, cv::IMREAD_UNCHANGED);
    if (depth.type() != CV_16UC1) return "not a 16 bit depth image: " + pair.depth.string();
    CObservation3DRangeScan record;
    if (!load(record.intensityImage, pair.color))
      return "unreadable image: " + pair.color.string();
    const cv::Size color_size(static_cast<int>(record.intensityImage.getWidth()), static_cast<int>(record.intensityImage.getHeight()));
    for (const auto& [file, size] : {std::pair(pair.color, color_size), std::pair(pair.depth, depth.size())})
      if (const auto problem = unfit(file, size); !problem.empty()) return problem;
    fill(record, depth);
    const double rate = options_.frame_rate_hz.value_or(1);
    record.timestamp = mrpt::Clock::fromDouble(pair.t / rate);
    if (options_.external_images) storeOutside(record, pair);
    output_.rawlog().write(record);
    return "";
  }
  const PinholeCamera& camera() const { return camera_.camera; }

 private:
  // Why an image does not fit the camera, whose size may be that of the first one.
  std::string unfit(const fs::path& file, const cv::Size& size) {
    auto& camera = camera_.camera;
    if (camera.width == 0) {
      camera.width = size.width;
      camera.height = size.height;
    }
    if (size == cv::Size(camera.width, camera.height)) return "";
    return file.string() + " is " + std::to_string(size.width) + "x" + std::to_string(size.height) + " px, the camera " +
           std::to_string(camera.width) + "x" + std::to_string(camera.height);
  }

  void fill(CObservation3DRangeScan& record, const cv::Mat& depth) const {
    record.sensorLabel = options_.label;
    record.hasIntensityImage = record.hasRangeImage = true;
    record.range_is_depth = true;
    record.rangeUnits = static_cast<float>(1 / camera_.depth_scale);
    record.maxRange = kMaxRangeM;
    record.sensorPose = roomgraph::toMrpt(options_.robot_from_sensor);
    record.rangeImage_setSize(depth.rows, depth.cols);
    for (int v = 0; v < depth.rows; ++v)
      for (int u = 0; u < depth.cols; ++u) {
        const std::uint16_t value = depth.at<std::uint16_t>(v, u);
        record.rangeImage(v, u) = value == camera_.invalid_depth ? 0 : value;
      }
    record.cameraParams = record.cameraParamsIntensity = toMrpt(camera_.camera);
  }

  void storeOutside(CObservation3DRangeScan& record, const TumPair& pair) {
    char stamp[64];
    std::snprintf(stamp, sizeof stamp, "_%.6f", pair.t);
    const std::string name = options_.label + stamp;
    const std::string color = name + "_rgb" + pair.color.extension().string();
    const fs::path& folder = output_.images();
    std::error_code error;
    fs::copy_file(pair.color, folder / color, fs::copy_options::overwrite_existing, error);
    if (error) throw RunError("cannot write " + (folder / color).string() + ": " + error.message());
    record.intensityImage.setExternalStorage(color);
    output_.storeDepth(record, name + "_depth.bin");
  }

  ImportOutput& output_;
  TumCamera camera_;
  const TumImportOptions& options_;
};

bool lookLikeFrameNumbers(const std::vector<TumPair>& pairs) {
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].t != std::floor(pairs[i].t) || (i > 0 && pairs[i].t - pairs[i - 1].t > 10)) return false;
  return pairs.size() > 1;
}

void writeAll(Writer& writer, const std::vector<TumPair>& pairs, TumImportResult& result,
              const std::function<void(std::size_t, std::size_t)>& progress) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string problem = writer.write(pairs[i]);
    if (problem.empty())
      ++result.written;
    else if (++result.missing <= kWarningsShown)
      result.warnings.push_back(kPairLeftOut + problem);
    if (progress) progress(i + 1, pairs.size());
  }
  if (result.missing > kWarningsShown)
    result.warnings.push_back(std::to_string(result.missing - kWarningsShown) + " more pairs left out");
  result.camera = writer.camera();
}

std::string firstReason(const std::vector<std::string>& warnings) {
  const auto left_out = [](const std::string& warning) { return warning.starts_with(kPairLeftOut); };
  const auto first = std::find_if(warnings.begin(), warnings.end(), left_out);
  return first == warnings.end() ? "" : *first;
}

// Stamps in other units would become times that no clock has.
void checkTimes(const std::vector<TumPair>& pairs, const fs::path& folder) {
  constexpr double kLatest_s = 7'258'118'400, kMicro = 1e6, kNano = 1e9;  // the year 2200
  if (pairs.empty()) return;
  const double t = pairs[pairs.size() / 2].t;
  if (t < kLatest_s) return;
  const char* const unit = t / kMicro < kLatest_s ? "microseconds" : t / kNano < kLatest_s ? "nanoseconds" : "no unit that is known";
  throw InputError(folder.string() + ": its time stamps are in " + unit + ", not in seconds: " + std::to_string(t));
}

// A principal point outside the image is a wrong number, or one for another image size.
void checkCenter(const PinholeCamera& camera, std::vector<std::string>& warnings) {
  if (camera.sees(camera.cx, camera.cy)) return;
  std::ostringstream text;
  text << "the principal point (" << camera.cx << ", " << camera.cy << ") lies outside the image of "
       << camera.width << "x" << camera.height << " px: check cx and cy";
  warnings.push_back(text.str());
}

// Everything that is read, or would be if another file were not there.
ImportInputs inputsOf(const fs::path& folder, const TumImportOptions& options,
                      const std::vector<TumPair>& pairs) {
  ImportInputs inputs{folder, {findGroundTruth(folder), options.camera_file.value_or(fs::path())}};
  for (const char* name :
       {"associations.txt", "association.txt", "associate.txt", "rgb.txt", "depth.txt", "camera.json"})
    inputs.files.push_back(folder / name);
  for (const auto& pair : pairs) inputs.files.insert(inputs.files.end(), {pair.color, pair.depth});
  std::erase(inputs.files, fs::path());
  return inputs;
}

}  // namespace

TumImportResult importTum(const fs::path& folder, const fs::path& rawlog, const TumImportOptions& options,
                          const std::function<void(std::size_t, std::size_t)>& progress) {
  if (options.frame_rate_hz && !(*options.frame_rate_hz > 0))
    throw ConfigError("the frame rate must be positive");
  TumImportResult result;
  const auto pairs = readTumPairs(folder, options.max_time_difference_s, result.warnings);
  checkTimes(pairs, folder);
  const ImportPlaces places = placesOf(rawlog);
  const ImportInputs inputs = inputsOf(folder, options, pairs);
  checkPlaces(places, inputs, options.external_images);
  const TumCamera camera = readTumCamera(folder, options);
  result.mirrored = camera.mirrored;
  if (camera.mirrored)
    result.warnings.push_back(
        "fy < 0: |fy| is used and the ground truth is mirrored in y to a right-handed world");
  if (!options.frame_rate_hz && lookLikeFrameNumbers(pairs))
    result.warnings.push_back("the time stamps look like frame numbers: give the frame rate (ICL-NUIM: 30)");
  ImportOutput output(places, options.external_images);
  Writer writer(output, camera, options);
  writeAll(writer, pairs, result, progress);
  if (result.written == 0)
    throw InputError(folder.string() + ": none of the " + std::to_string(pairs.size()) +
                     " pairs can be used; " + firstReason(result.warnings));
  checkCenter(result.camera, result.warnings);
  if (const auto truth = findGroundTruth(folder); !truth.empty()) {
    result.ground_truth = places.ground_truth;
    output.setGroundTruth(groundTruthText(truth, camera.mirrored, options.frame_rate_hz), TruthOf::kCamera);
  }
  for (const auto& removed : output.commit(inputs))
    result.warnings.push_back(removed.string() + " of the former import was removed: this one has none");
  return result;
}

}  // namespace roomgraph
