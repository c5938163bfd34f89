// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/mapping/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "roomgraph/core/errors.h"

namespace roomgraph {

void writeFileAtomically(const std::filesystem::path& file, std::string_view bytes) {
  auto temporary = file;
  temporary += ".tmp" + std::to_string(getpid());
  const auto fail = [&](const std::string& cause) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw RunError("cannot write " + file.string() + ": " + cause);
  };
  errno = 0;
  std::ofstream out(temporary, std::ios::binary);
  if (!out) fail(std::strerror(errno));
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) fail(std::strerror(errno));
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) fail(error.message());
}

}  // namespace roomgraph
