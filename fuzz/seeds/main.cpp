// SPDX-License-Identifier: BSD-3-Clause
// fuzz_seeds DIR: writes the seeds of all targets as DIR/TARGET/NAME.
#include <exception>
#include <fstream>
#include <iostream>

#include "../target.h"
#include "corpus.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph::fuzz {

void Corpus::add(const std::string& target, const std::string& name, std::string_view bytes) {
  std::filesystem::create_directories(folder_ / target);
  std::ofstream(folder_ / target / name, std::ios::binary) << bytes;
  ++written_;
}

void Corpus::add(const std::string& target, const std::string& name, const std::vector<std::string>& parts) {
  std::string all;
  for (std::size_t i = 0; i < parts.size(); ++i) all += (i > 0 ? std::string(kPartMark) : "") + parts[i];
  add(target, name, all);
}

}  // namespace roomgraph::fuzz

int main(int argc, char** argv) {
  using namespace roomgraph::fuzz;
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds DIR\n";
    return 2;
  }
  try {
    roomgraph::observations::registerClasses();
    Corpus corpus(argv[1]);
    for (const auto add :
         {addRawlogs, addMaps, addSettings, addResults, addCheckpoints, addNetworks, addFolders, addBags})
      add(corpus);
    std::cout << corpus.written() << " seeds in " << argv[1] << "\n";
  } catch (const std::exception& error) {
    std::cerr << "fuzz_seeds: " << error.what() << "\n";
    return 1;
  }
}
