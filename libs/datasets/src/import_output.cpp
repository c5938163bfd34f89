// SPDX-License-Identifier: BSD-3-Clause
// Checks against overwriting of inputs, and atomic exchange of rawlog, images and ground truth.
#include "roomgraph/datasets/import_output.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <memory>
#include <string_view>

#include "image_folder.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/paths.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

fs::path unfinished(const fs::path& file) {
  return file.string() + ".unfinished";
}

// Nothing may be written or removed there.
bool isRead(const fs::path& folder, const ImportInputs& inputs) {
  return isInside(folder, inputs.folder) || isInside(inputs.folder, folder) ||
         std::any_of(inputs.files.begin(), inputs.files.end(),
                     [&](const fs::path& file) { return isInside(file, folder); });
}

bool isStamp(std::string_view text) {
  constexpr std::size_t kDecimals = 6;
  if (text.starts_with('-')) text.remove_prefix(1);
  const auto digits = [](std::string_view part) {
    return !part.empty() &&
           std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c); });
  };
  const auto point = text.find('.');
  return point != text.npos && digits(text.substr(0, point)) && digits(text.substr(point + 1)) &&
         text.size() - point - 1 == kDecimals;
}

// LABEL_STAMP_rgb.ENDING or LABEL_STAMP_depth.bin.
bool isImageName(std::string_view name) {
  constexpr std::string_view kDepth = "_depth.bin", kColor = "_rgb";
  auto end = name.ends_with(kDepth) ? name.size() - kDepth.size() : name.rfind(kColor);
  if (end == name.npos) return false;
  if (!name.ends_with(kDepth) && end + kColor.size() < name.size() && name[end + kColor.size()] != '.')
    return false;
  const std::string_view stem = name.substr(0, end);
  const auto bar = stem.rfind('_');
  return bar != stem.npos && bar > 0 && isStamp(stem.substr(bar + 1));
}

// Nothing but images of an import, whatever its label was.
bool wasImported(const fs::path& folder) {
  std::error_code error;
  if (fs::is_symlink(folder, error) || !fs::is_directory(folder, error)) return false;
  const fs::directory_iterator entries(folder, error);
  return !error && std::all_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
    return entry.is_regular_file() && !entry.is_symlink() && isImageName(entry.path().filename().string());
  });
}

void moveFolder(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw RunError("cannot write " + to.string() + ": " + error.message());
}

// Bytes that can be read back. MRPT says nothing when the disk is full.
std::size_t sizeOfGzip(const fs::path& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  std::array<char, 1 << 16> block;
  std::size_t size = 0;
  for (int got = 1; in && got > 0; size += static_cast<std::size_t>(std::max(got, 0)))
    got = gzread(in.get(), block.data(), block.size());
  return size;
}

}  // namespace

ImportPlaces placesOf(const fs::path& rawlog) {
  const fs::path name = withoutEndings(rawlog);
  return {rawlog, name.string() + "_Images", name.string() + ".groundtruth.txt"};
}

void checkPlaces(const ImportPlaces& places, const ImportInputs& inputs, bool external_images) {
  const fs::path& rawlog = places.rawlog;
  if (fs::is_directory(rawlog))
    throw RunError(rawlog.string() + ": is a folder; name the rawlog to write, e.g. " +
                   (rawlog / "recording.rawlog").string());
  const fs::path parent = fs::absolute(rawlog).parent_path();
  if (!fs::is_directory(parent)) throw RunError(rawlog.string() + ": there is no folder " + parent.string());
  std::error_code ignored;
  for (const auto& file : inputs.files)
    for (const auto& place : {rawlog, places.ground_truth})
      if (fs::equivalent(file, place, ignored))
        throw ConfigError(place.string() +
                          ": is read by this import and would be replaced; name another rawlog");
  if (!external_images) return;
  for (const auto& folder : {places.images, unfinished(places.images)})
    if (isRead(folder, inputs))
      throw ConfigError(folder.string() + ": the external images would be written where " +
                        inputs.folder.string() + " is read; name another rawlog");
  if (fs::exists(fs::symlink_status(places.images)) && !wasImported(places.images))
    throw ConfigError(places.images.string() +
                      ": is not from an import and would be replaced; name another rawlog, or move it away");
}

ImportOutput::ImportOutput(ImportPlaces places, bool external_images)
    : places_(std::move(places)), replaces_(fs::exists(places_.rawlog)), rawlog_(places_.rawlog) {
  if (!external_images) return;
  pending_ = unfinished(places_.images);
  new_images_ = pending_ / "new";
  old_images_ = pending_ / "old";
  std::error_code error;
  restoreImages();  // an import was ended while it put its images into place
  fs::remove_all(pending_, error);
  fs::create_directories(new_images_, error);
  if (error) throw RunError(new_images_.string() + ": cannot be made: " + error.message());
}

ImportOutput::~ImportOutput() {
  std::error_code ignored;
  const bool keeps_old = !committed_ && fs::exists(old_images_, ignored);  // they could not be put back
  if (!pending_.empty() && !keeps_old) fs::remove_all(pending_, ignored);
}

void ImportOutput::setGroundTruth(const std::string& text, TruthOf whose) {
  ground_truth_.emplace(places_.ground_truth);
  OutputFile out(ground_truth_->path());
  const std::string comment = truthComment(whose);
  out << (text.starts_with(comment) ? "" : comment) << text;
  out.finish();
}

void ImportOutput::storeDepth(mrpt::obs::CObservation3DRangeScan& record, const std::string& name) const {
  const auto bytes = record.rangeImage.size() * sizeof(std::uint16_t);
  record.rangeImage_convertToExternalStorage(name, new_images_.string() + "/");
  if (sizeOfGzip(new_images_ / name) < bytes) failToWrite(new_images_ / name, ENOSPC);
}

// When there are no others in their place.
void ImportOutput::restoreImages() {
  std::error_code ignored;
  if (fs::exists(old_images_, ignored) && !fs::exists(places_.images, ignored))
    fs::rename(old_images_, places_.images, ignored);
}

void ImportOutput::swapImages() {
  if (fs::exists(places_.images)) moveFolder(places_.images, old_images_);
  moveFolder(new_images_, places_.images);
}

std::vector<fs::path> ImportOutput::commit(const ImportInputs& inputs) {
  rawlog_.close();  // the disk may turn out to be full only now
  try {
    if (!pending_.empty()) swapImages();
    rawlog_.commit();
  } catch (const RunError&) {
    std::error_code ignored;
    if (!pending_.empty() && !fs::exists(new_images_, ignored))
      fs::rename(places_.images, new_images_, ignored);
    restoreImages();
    throw;
  }
  committed_ = true;
  std::vector<fs::path> removed;
  std::error_code ignored;
  if (ground_truth_)
    ground_truth_->commit();
  else if (replaces_ && fs::remove(places_.ground_truth, ignored))
    removed.push_back(places_.ground_truth);
  if (pending_.empty() && replaces_ && wasImported(places_.images) && !isRead(places_.images, inputs) &&
      fs::remove_all(places_.images, ignored) > 0)
    removed.push_back(places_.images);
  return removed;
}

}  // namespace roomgraph
