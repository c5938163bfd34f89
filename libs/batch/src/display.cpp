// SPDX-License-Identifier: BSD-3-Clause
// Lines of the display, and the escape sequences that draw it anew.
#include "display.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "roomgraph/core/terminal.h"

namespace roomgraph {
namespace {

constexpr int kBar = 24;

}  // namespace

std::string clockText(double seconds) {
  const long all = std::lround(std::max(0.0, seconds));
  char text[48];
  if (all >= 3600)
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", all / 3600, all / 60 % 60, all % 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld", all / 60, all % 60);
  return text;
}

std::string taskLine(const ShownTask& task, std::size_t name_width) {
  std::string line = task.name.substr(0, name_width);
  line.resize(name_width, ' ');
  const int full = static_cast<int>(std::lround(kBar * std::clamp(task.share, 0.0, 1.0)));
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100 * std::max(0.0, task.share));
  return line + "  [" + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(kBar - full), '.') + "] " +
         (task.share < 0 ? "     " : percent) + "  " + clockText(task.elapsed_s);
}

std::string totalsLine(const ShownTotals& totals, const std::vector<ShownTask>& running, double elapsed_s) {
  double worked = static_cast<double>(totals.done + totals.failed);
  for (const auto& task : running) worked += std::max(0.0, task.share);
  const double left = static_cast<double>(totals.all - totals.skipped) - worked;
  std::string line =
      std::to_string(totals.done + totals.skipped) + " of " + std::to_string(totals.all) + " runs complete";
  if (totals.skipped > 0) line += " (" + std::to_string(totals.skipped) + " from before)";
  if (totals.failed > 0) line += ", " + std::to_string(totals.failed) + " failed";
  line += "; " + std::to_string(totals.running) + " running; " +
          (totals.queued > 0 ? std::to_string(totals.queued) + " queued; " : "") + clockText(elapsed_s);
  if (worked > 0.02 && left > 0) line += ", about " + clockText(elapsed_s * left / worked) + " left";
  return line;
}

double BatchDisplay::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void BatchDisplay::clear() {
  if (lines_ > 0) *view_.out << "\033[" << lines_ << "A\033[J" << std::flush;
  lines_ = 0;
}

void BatchDisplay::event(const std::string& line) {
  if (!view_.out) return;
  clear();
  *view_.out << line << std::endl;
  last_ = {};
}

bool BatchDisplay::isDue() const {
  return view_.out && view_.terminal &&
         std::chrono::steady_clock::now() - last_ >= std::chrono::milliseconds(200);
}

void BatchDisplay::draw(const ShownTotals& totals, const std::vector<ShownTask>& running) {
  if (!isDue()) return;
  last_ = std::chrono::steady_clock::now();
  std::size_t name_width = 8;
  for (const auto& task : running) name_width = std::max(name_width, task.name.size());
  const std::size_t width = terminalWidth(STDERR_FILENO) - 1, room = width > 50 ? width - 50 : 8;
  std::vector<std::string> lines;
  for (const auto& task : running) lines.push_back(taskLine(task, std::min(name_width, room)));
  lines.push_back(totalsLine(totals, running, elapsed()));
  clear();
  for (const auto& line : lines) *view_.out << line.substr(0, width) << "\n";
  *view_.out << std::flush;
  lines_ = lines.size();
}

}  // namespace roomgraph
