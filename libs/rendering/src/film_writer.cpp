// SPDX-License-Identifier: BSD-3-Clause
// OpenCV's VideoWriter, and PNGs.
#include "film_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

/// Codecs by ending, the one that most players know first.
const std::map<std::string, std::vector<std::string>>& codecs() {
  static const std::map<std::string, std::vector<std::string>> known{
      {".mp4", {"avc1", "mp4v"}}, {".webm", {"VP80", "VP90"}}, {".avi", {"MJPG"}}};
  return known;
}

/// In small letters: ".MP4" is one, too.
std::string endingOf(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

int fourCc(const std::string& name) {
  return cv::VideoWriter::fourcc(name[0], name[1], name[2], name[3]);
}

/// OpenCV has its own words for a codec that is missing, some of them by way of the standard error; ours say
/// what to do.
class QuietOpenCv {
 public:
  QuietOpenCv()
      : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)), error_(dup(2)) {
    const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (error_ >= 0 && nothing >= 0) dup2(nothing, 2);
    if (nothing >= 0) close(nothing);
  }
  ~QuietOpenCv() {
    if (error_ >= 0) dup2(error_, 2), close(error_);
    cv::utils::logging::setLogLevel(level_);
  }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel level_;
  int error_;
};

/// Written beside its place, under a name with the same ending, from which OpenCV takes the container.
class Video : public FrameSink {
 public:
  Video(const fs::path& file, double fps, const cv::Size& size)
      : size_(size), place_(file), temporary_(fs::path(file).replace_extension(".unfinished" + endingOf(file))) {
    OutputFile(temporary_).finish();  // says why when that cannot be written
    const QuietOpenCv quiet;
    for (const auto& codec : codecs().at(endingOf(file)))
      if (!writer_.isOpened()) writer_.open(temporary_.string(), fourCc(codec), fps, size);
    if (writer_.isOpened()) return;
    remove();
    throw RunError("cannot write " + file.string() + ": this OpenCV has no codec for " +
                   file.extension().string() + " at " + std::to_string(size.width) + "x" +
                   std::to_string(size.height) + "; name a folder for numbered PNGs, or an .avi");
  }
  ~Video() override {
    writer_.release();
    remove();
  }
  void add(const cv::Mat& frame) override {
    // OpenCV leaves out frames of another size without a word.
    if (frame.size() != size_) throw std::logic_error("a frame of a film has another size than the first");
    writer_.write(frame);
  }
  void finish() override {
    writer_.release();
    flushToDisk(temporary_);
    std::error_code error;
    if (fs::file_size(temporary_, error) == 0 || error)
      throw RunError("cannot write " + place_.string() + ": nothing came");
    fs::rename(temporary_, place_, error);
    if (error) throw RunError("cannot write " + place_.string() + ": " + error.message());
  }

 private:
  void remove() {
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  }

  cv::Size size_;
  fs::path place_, temporary_;
  cv::VideoWriter writer_;
};

class Pictures : public FrameSink {
 public:
  explicit Pictures(const fs::path& folder) : folder_(folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder, error))
      throw RunError("cannot make the folder " + folder.string() + (error ? ": " + error.message() : ""));
    if (fs::exists(picture(0)))
      throw RunError(folder.string() + ": holds the frames of a film; empty it or name another folder");
  }
  void add(const cv::Mat& frame) override {
    std::vector<unsigned char> bytes;
    cv::imencode(".png", frame, bytes);
    writeFileAtomically(picture(count_++), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  void finish() override {}

 private:
  fs::path picture(int number) const {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%05d.png", number);
    return folder_ / name;
  }
  fs::path folder_;
  int count_ = 0;
};

}  // namespace

std::unique_ptr<FrameSink> makeFrameSink(const fs::path& place, double fps, const cv::Size& size) {
  if (codecs().count(endingOf(place))) return std::make_unique<Video>(place, fps, size);
  return std::make_unique<Pictures>(place);
}

}  // namespace roomgraph
