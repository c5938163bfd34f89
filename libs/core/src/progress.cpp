// SPDX-License-Identifier: BSD-3-Clause
// Formatting and rate limit of the progress line.
#include "roomgraph/core/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "roomgraph/core/terminal.h"

namespace roomgraph {

Progress::Progress(std::ostream* out, std::string label, std::string unit, double total)
    : out_(out),
      label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      terminal_(out == &std::cerr && isatty(STDERR_FILENO)),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

std::string Progress::line(double done, const std::string& note) const {
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double rate = elapsed > 0 ? done / elapsed : 0;
  char text[160];
  if (total_ > 0 && rate > 0 && unit_.empty()) {
    std::snprintf(text, sizeof text, "%s %3.0f %%  %.0f s left", label_.c_str(), 100 * done / total_,
                  std::ceil(std::max(0.0, (total_ - done) / rate)));
  } else if (total_ > 0 && rate > 0) {
    const double left = std::max(0.0, (total_ - done) / rate);
    std::snprintf(text, sizeof text, "%s %3.0f %%  %.0f/%.0f %s  %.1f %s/s  %.0f s left", label_.c_str(),
                  100 * done / total_, done, total_, unit_.c_str(), rate, unit_.c_str(), std::ceil(left));
  } else {
    std::snprintf(text, sizeof text, "%s %.0f %s  %.1f %s/s", label_.c_str(), done, unit_.c_str(), rate,
                  unit_.c_str());
  }
  return note.empty() ? text : std::string(text) + "  " + note;
}

void Progress::update(double done, const std::string& note) {
  if (!out_) return;
  const auto now = std::chrono::steady_clock::now();
  const double pause = terminal_ ? 0.2 : 10.0;
  if (std::chrono::duration<double>(now - last_).count() < pause) return;
  last_ = now;
  std::string text = line(done, note);
  if (terminal_) {
    // A line that goes on in the next row cannot be written over.
    const std::size_t room = terminalWidth(STDERR_FILENO) - 1, width = std::min(text.size(), room);
    text.resize(width);
    text.resize(std::max(width, std::min(width_, room)), ' ');
    width_ = width;
    *out_ << '\r' << text << std::flush;
  } else {
    *out_ << text << std::endl;
  }
}

void Progress::finish(const std::string& note) {
  if (!out_) return;
  if (terminal_) {
    const std::size_t written = std::min(width_, terminalWidth(STDERR_FILENO) - 1);
    *out_ << '\r' << std::string(written, ' ') << '\r';
  }
  if (!note.empty()) *out_ << note << std::endl;
}

}  // namespace roomgraph
