// SPDX-License-Identifier: BSD-3-Clause
// Clocks of the topics against that of the recorder, and against each other.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "import_plan.h"
#include "roomgraph/core/order_statistics.h"

namespace roomgraph::bags {
namespace {

struct TopicClock {
  std::size_t topic = 0;
  ClockDelays::Summary delay;
};

std::vector<TopicClock> clocksOf(const Survey& survey, const ImportPlan& plan) {
  std::vector<TopicClock> clocks;
  for (const auto& [topic, label] : plan.labels)
    if (const auto delay = survey.topics[topic].header_minus_received.summary())
      clocks.push_back({topic, *delay});
  return clocks;
}

std::string seconds(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f s", value);
  return text;
}

double medianDelay(const std::vector<TopicClock>& clocks) {
  std::vector<double> delays;
  for (const auto& clock : clocks) delays.push_back(clock.delay.median);
  return median(delays);
}

std::string setBack(const std::vector<ClockRestart>& restarts) {
  std::int64_t most_ns = 0;
  for (const auto& restart : restarts) most_ns = std::max(most_ns, restart.back_ns);
  const std::string by = "set back by " + seconds(1e-9 * static_cast<double>(most_ns));
  return restarts.size() == 1 ? by : by + " at most, " + std::to_string(restarts.size()) + " times";
}

void tellRestarts(const Survey& survey, std::vector<std::string>& warnings) {
  if (!survey.restarts.empty())
    warnings.push_back("clocks: they are " + setBack(survey.restarts) +
                       " within the bag; records keep their times, in the order of reception there");
  else if (!survey.receptions.empty())
    warnings.push_back("clocks: the recorder's is " + setBack(survey.receptions) +
                       " within the bag, those of the sensors are not");
}

}  // namespace

void planTimes(const Survey& survey, const BagImportOptions& options, ImportPlan& plan) {
  constexpr double kOff_s = 0.2, kDrift_s = 0.1, kWidest_s = 5;
  tellRestarts(survey, plan.warnings);
  const auto clocks = clocksOf(survey, plan);
  const double usual = medianDelay(clocks);
  double spread = 0;
  for (const auto& [topic, delay] : clocks) {
    const std::string& name = survey.topics[topic].topic.name;
    const double off = delay.median - usual, drift = delay.last - delay.first;
    spread = std::max(spread, std::abs(off));
    if (std::abs(off) > kOff_s)
      plan.warnings.push_back(
          name + ": clock is " + seconds(std::abs(off)) + (off < 0 ? " behind" : " ahead of") +
          " those of the other sensors (header times against reception); --times corrected shifts it");
    const bool steady = survey.restarts.size() == survey.receptions.size();
    if (steady && std::abs(drift) > kDrift_s)
      plan.warnings.push_back(name + ": clock drifts by " + seconds(drift) +
                              " against the recorder's from the first to the last quarter");
    if (options.times == BagTimes::kCorrected)
      plan.shifts_ns[topic] = static_cast<std::int64_t>(std::llround(-1e9 * delay.median));
  }
  for (const auto& [topic, label] : plan.labels)
    if (const auto& surveyed = survey.topics[topic]; surveyed.unstamped > 0)
      plan.warnings.push_back(surveyed.topic.name + ": " + std::to_string(surveyed.unstamped) + " of " +
                              std::to_string(surveyed.count) +
                              " messages have no time in their header: the time of reception is used");
  // Colour and depth of one driver stay together.
  const auto& choice = plan.choice;
  if (choice.color && choice.depth && plan.shifts_ns.contains(*choice.color))
    plan.shifts_ns[*choice.depth] = plan.shifts_ns[*choice.color];
  if (options.times == BagTimes::kHeader) plan.window_s += std::min(spread, kWidest_s);
}

}  // namespace roomgraph::bags
