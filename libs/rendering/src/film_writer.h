// SPDX-License-Identifier: BSD-3-Clause
// Frames into a video file or a folder of numbered pictures.
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace roomgraph {

/// Where the frames of a film go.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// BGR, all of one size. Throws RunError when it cannot be written.
  virtual void add(const cv::Mat& frame) = 0;
  /// Makes what was added a film. Without it a video leaves nothing; pictures stay.
  virtual void finish() = 0;
};

/// A video for .mp4, .webm and .avi (in small letters or capitals), else a folder that gets frame_00000.png
/// and so on. Throws RunError as writeFilm().
std::unique_ptr<FrameSink> makeFrameSink(const std::filesystem::path& place, double fps,
                                         const cv::Size& size);

}  // namespace roomgraph
