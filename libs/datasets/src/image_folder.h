// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <filesystem>
#include <string>

namespace roomgraph {

/// Folder of a rawlog's external images by MRPT's convention: "x_Images" beside "x.rawlog" (or
/// "x.rawlog.gz"), otherwise "Images". CRawlog::detectImagesDirectory() of MRPT 2.5 loses the slash after the
/// folder of a full path.
inline std::string imageFolderOf(std::filesystem::path file) {
  file = std::filesystem::absolute(file);
  if (file.extension() == ".gz") file.replace_extension();
  for (const char* ending : {"_Images", "_images", "_IMAGES"}) {
    const auto folder = file.parent_path() / (file.stem().string() + ending);
    if (std::filesystem::is_directory(folder)) return folder.string();
  }
  return (file.parent_path() / "Images").string();
}

}  // namespace roomgraph
