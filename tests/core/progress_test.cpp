// SPDX-License-Identifier: BSD-3-Clause
// Progress line: silence without a stream, few lines in a file, one row on a terminal.
#include "roomgraph/core/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace roomgraph {
namespace {

using ::testing::MatchesRegex;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Standard error is a terminal of this width while it lives.
class TerminalOnStderr {
 public:
  explicit TerminalOnStderr(unsigned short columns) : former_(dup(STDERR_FILENO)) {
    winsize size{24, columns, 0, 0};
    int inner = -1;
    if (openpty(&outer_, &inner, nullptr, nullptr, &size) != 0)
      throw std::runtime_error("no pseudo-terminal");
    dup2(inner, STDERR_FILENO);
    close(inner);
  }
  ~TerminalOnStderr() {
    dup2(former_, STDERR_FILENO);
    close(former_);
    close(outer_);
  }
  // What has been written since the last call: a terminal hands it over in pieces, so up to an end mark.
  std::string text() {
    constexpr char kEnd = '\1';
    if (write(STDERR_FILENO, &kEnd, 1) != 1) throw std::runtime_error("cannot write to the pseudo-terminal");
    std::string text;
    while (text.empty() || text.back() != kEnd) {
      char bytes[4096];
      const auto count = read(outer_, bytes, sizeof bytes);
      if (count <= 0) throw std::runtime_error("the pseudo-terminal is closed");
      text.append(bytes, static_cast<std::size_t>(count));
    }
    text.pop_back();
    return text;
  }

 private:
  int former_, outer_ = -1;
};

// An update is shown when the last one is a while ago.
void wait() {
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
}

TEST(Progress, SilentWithoutStream) {
  Progress progress(nullptr, "run", "frames", 10);
  progress.update(5, "note");
  progress.finish("done");
}

TEST(Progress, DoesNotFloodAFile) {
  std::ostringstream out;
  Progress progress(&out, "run", "frames", 1000);
  for (int i = 0; i < 1000; ++i) progress.update(i);
  EXPECT_EQ(out.str(), "");
  progress.finish("1000 frames");
  EXPECT_EQ(out.str(), "1000 frames\n");
}

TEST(Progress, TellsShareRateAndTimeLeft) {
  TerminalOnStderr terminal(120);
  const auto before = Clock::now();
  Progress progress(&std::cerr, "run", "frames", 1000);
  const auto after = Clock::now();
  wait();
  const double at_least = secondsSince(after);
  progress.update(250, "2 objects");
  const double at_most = secondsSince(before);
  const std::string text = terminal.text();
  std::smatch parts;
  ASSERT_TRUE(std::regex_match(
      text, parts,
      std::regex("\rrun  25 %  250/1000 frames  ([0-9.]+) frames/s  ([0-9]+) s left  2 objects")))
      << text;
  const double rate = std::stod(parts[1]);
  EXPECT_GE(rate, 250 / at_most - 0.05) << "rounded to a tenth";
  EXPECT_LE(rate, 250 / at_least + 0.05);
  EXPECT_GE(std::stod(parts[2]), std::ceil(3 * at_least)) << "three times as much is left as was done";
  EXPECT_LE(std::stod(parts[2]), std::ceil(3 * at_most));
}

TEST(Progress, WithoutUnitTheShareAlone) {
  TerminalOnStderr terminal(120);
  Progress progress(&std::cerr, "batch", "", 1);
  wait();
  progress.update(0.5);
  EXPECT_THAT(terminal.text(), MatchesRegex("\rbatch  50 %  [0-9]+ s left"));
}

TEST(Progress, WithoutTotalWhatWasDone) {
  TerminalOnStderr terminal(120);
  Progress progress(&std::cerr, "read", "records", 0);
  wait();
  progress.update(42);
  EXPECT_THAT(terminal.text(), MatchesRegex("\rread 42 records  [0-9.]+ records/s"));
}

TEST(Progress, RewritesOneRowAndRemovesIt) {
  TerminalOnStderr terminal(20);
  Progress progress(&std::cerr, "read", "records", 0);
  progress.update(1);
  wait();
  progress.update(2, "a note that is longer than the row");
  const std::string first = terminal.text();
  EXPECT_EQ(first.size(), 1 + 19u) << "too soon for the first; a row of 20 columns must not be filled";
  EXPECT_EQ(first.substr(0, 7), "\rread 2");
  progress.finish("2 records");
  EXPECT_EQ(terminal.text(), "\r" + std::string(19, ' ') + "\r2 records\r\n");
}

}  // namespace
}  // namespace roomgraph
