// SPDX-License-Identifier: BSD-3-Clause
// fuzz_replay SEEDS [MUTATIONS [TARGET]]: each seed and so many damaged copies of each, without libFuzzer.
// Ends at the first finding, with the target, the seed and the number of the copy; that copy stays in
// `finding`.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>

#include "memory_limit.h"
#include "mutate.h"
#include "target.h"

namespace roomgraph::fuzz {
namespace {

constexpr double kLongest_s = 5, kMostMegabytes = 1024;

/// What is being read, for whoever ends the program.
struct Running {
  std::string label, bytes;
} running;

[[noreturn]] void fail(const std::string& what) {
  std::cerr << running.label << ": " << what << " (the input is in the file 'finding')\n";
  std::ofstream("finding", std::ios::binary) << running.bytes;
  std::_Exit(1);
}

void onSignal(int signal) {
  fail("ended by signal " + std::to_string(signal));
}

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A seed is sound.
void read(const Target& target, double memory_before_mb, bool is_seed) {
  const auto start = std::chrono::steady_clock::now();
  try {
    const std::string refusal = readWith(target, running.bytes);
    if (is_seed && !refusal.empty()) fail("refused: " + refusal);
  } catch (const std::exception& error) {
    fail(std::string("an exception that is no Error: ") + error.what());
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (took.count() > kLongest_s) fail("took " + std::to_string(took.count()) + " s");
  if (test::kMemoryCanBeLimited && test::peakMegabytes() - memory_before_mb > kMostMegabytes)
    fail("needed more than a gigabyte");
}

int replay(const Target& target, const std::filesystem::path& folder, unsigned mutations) {
  std::vector<std::filesystem::path> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) seeds.push_back(entry.path());
  std::sort(seeds.begin(), seeds.end());
  const double memory_mb = test::peakMegabytes();
  int count = 0;
  for (const auto& seed : seeds) {
    const std::string good = contentOf(seed);
    for (unsigned i = 0; i <= mutations; ++i, ++count) {
      test::Mutator mutator(i);
      const bool binary = good.find('\0') != std::string::npos;
      running.label = target.name + "/" + seed.filename().string() + " mutation " + std::to_string(i);
      running.bytes = i == 0 ? good : binary || i % 4 == 0 ? mutator.binary(good) : mutator.text(good);
      read(target, memory_mb, i == 0);
    }
  }
  return count;
}

int run(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: fuzz_replay SEEDS [MUTATIONS [TARGET]]\n";
    return 2;
  }
  const unsigned mutations = argc > 2 ? static_cast<unsigned>(std::strtoul(argv[2], nullptr, 10)) : 0;
  const std::string only = argc > 3 ? argv[3] : "";
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, onSignal);
  int targets_run = 0, total = 0;
  for (const auto& target : targets()) {
    if (!only.empty() && target.name != only) continue;
    const auto folder = std::filesystem::path(argv[1]) / target.name;
    if (!std::filesystem::is_directory(folder)) {
      std::cerr << target.name << ": no seeds\n";
      return 1;
    }
    total += replay(target, folder, mutations);
    ++targets_run;
  }
  std::cout << total << " inputs for " << targets_run << " targets, no finding\n";
  return targets_run > 0 ? 0 : 2;
}

}  // namespace
}  // namespace roomgraph::fuzz

int main(int argc, char** argv) {
  return roomgraph::fuzz::run(argc, argv);
}
