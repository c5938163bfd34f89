// SPDX-License-Identifier: BSD-3-Clause
// Folder of a rawlog's external images by MRPT's naming convention.
#pragma once

#include <filesystem>
#include <string>

namespace roomgraph {

/// Path of "x.rawlog" or "x.rawlog.gz" without its endings; the names of what is beside it begin so.
inline std::filesystem::path withoutEndings(std::filesystem::path file) {
  if (file.extension() == ".gz") file.replace_extension();
  return file.replace_extension();
}

/// Folder of a rawlog's external images by MRPT's convention: "x_Images" beside "x.rawlog" (or
/// "x.rawlog.gz"), otherwise "Images". CRawlog::detectImagesDirectory() of MRPT 2.5 loses the slash after the
/// folder of a full path.
inline std::string imageFolderOf(std::filesystem::path file) {
  file = withoutEndings(std::filesystem::absolute(file));
  for (const char* ending : {"_Images", "_images", "_IMAGES"})
    if (auto folder = file.string() + ending; std::filesystem::is_directory(folder)) return folder;
  return (file.parent_path() / "Images").string();
}

/// Makes the external images of a rawlog those of its copy, by a link beside it; nothing where there are
/// none, or the copy finds them itself. Throws RunError.
void linkImages(const std::filesystem::path& input, const std::filesystem::path& output);

}  // namespace roomgraph
