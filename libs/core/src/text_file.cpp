// SPDX-License-Identifier: BSD-3-Clause
// Text file read at once; missing files and folders reported as InputError.
#include "roomgraph/core/text_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace roomgraph {

std::string readTextFile(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw InputError(file.string() + ": cannot be opened: no such file");
  if (std::filesystem::is_directory(file, error))
    throw InputError(file.string() + ": cannot be opened: is a folder");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": cannot be opened: " + std::strerror(errno));
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace roomgraph
