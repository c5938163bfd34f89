// SPDX-License-Identifier: BSD-3-Clause
// Version and revision from the build system, command line from /proc/self/cmdline.
#include "program.h"

#include <fstream>

#include "revision.h"

namespace roomgraph {

const char* const kVersion = ROOMGRAPH_VERSION;
const char* const kRevision = ROOMGRAPH_REVISION;

std::vector<std::string> commandLine() {
  std::vector<std::string> words;
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  for (std::string word; std::getline(in, word, '\0');) words.push_back(word);
  return words;
}

}  // namespace roomgraph
