// SPDX-License-Identifier: BSD-3-Clause
// Entry points of libFuzzer; the environment variable ROOMGRAPH_FUZZ_TARGET names the target; with
// ROOMGRAPH_FUZZ_TELL, what the reader answers is printed.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "target.h"

namespace {

const roomgraph::fuzz::Target* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("ROOMGRAPH_FUZZ_TARGET");
  chosen = roomgraph::fuzz::findTarget(name ? name : "");
  if (chosen) return 0;
  std::fprintf(stderr, "ROOMGRAPH_FUZZ_TARGET names one of these targets:\n");
  for (const auto& target : roomgraph::fuzz::targets()) std::fprintf(stderr, "%s\n", target.name.c_str());
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string refusal = roomgraph::fuzz::readWith(*chosen, {reinterpret_cast<const char*>(data), size});
  static const bool tells = std::getenv("ROOMGRAPH_FUZZ_TELL");
  if (tells) std::printf("%s\n", refusal.empty() ? "used" : ("refused: " + refusal).c_str());
  return 0;
}
