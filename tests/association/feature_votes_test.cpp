// SPDX-License-Identifier: BSD-3-Clause
// Shares of landmarks by feature points against their definition, sighting by sighting.
#include "feature_votes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace roomgraph {
namespace {

struct SeenPoints {
  std::vector<std::vector<WorldMeasurement>> frames;
  std::vector<std::vector<BatchDecision>> decisions;
};

// Forty frames of up to three measurements, each with up to five of thirty points, on four landmarks.
SeenPoints randomSightings(std::mt19937& random) {
  std::vector<std::int64_t> points;
  for (int i = 0; i < 30; ++i) points.push_back(1000 - 7 * i);
  SeenPoints out;
  for (int f = 0; f < 40; ++f) {
    out.frames.emplace_back();
    out.decisions.emplace_back();
    for (unsigned k = 0; k < random() % 4; ++k) {
      std::shuffle(points.begin(), points.end(), random);
      WorldMeasurement seen;
      seen.measurement.features.assign(points.begin(), points.begin() + random() % 6);
      out.frames.back().push_back(seen);
      out.decisions.back().push_back({{}, LandmarkId{static_cast<std::int64_t>(random() % 4)}});
    }
  }
  return out;
}

// Sightings of the point by all measurements but one, on this landmark; invalid: on any.
int othersOf(const SeenPoints& seen, std::int64_t point, std::size_t frame, std::size_t measurement, LandmarkId on) {
  int count = 0;
  for (std::size_t f = 0; f < seen.frames.size(); ++f)
    for (std::size_t k = 0; k < seen.frames[f].size(); ++k) {
      const auto& points = seen.frames[f][k].measurement.features;
      const bool is_other = f != frame || k != measurement;
      const bool is_on = !on.valid() || seen.decisions[f][k].landmark == on;
      count += is_other && is_on && std::count(points.begin(), points.end(), point) > 0;
    }
  return count;
}

TEST(FeatureVotes, SharesAreThoseOfTheOtherSightings) {
  std::mt19937 random(3);
  SeenPoints seen = randomSightings(random);
  const std::vector<LandmarkId> ids{LandmarkId{2}, LandmarkId{0}, LandmarkId{7}, LandmarkId{}};
  constexpr double kNeutral = 2;
  FeatureVotes votes(seen.frames);
  for (int round = 0; round < 2; ++round) {
    votes.count(seen.decisions);
    for (std::size_t f = 0; f < seen.frames.size(); ++f)
      for (std::size_t k = 0; k < seen.frames[f].size(); ++k) {
        const auto shares = votes.shares(f, k, seen.decisions[f][k].landmark, ids, kNeutral);
        ASSERT_EQ(shares.size(), ids.size());
        double known = 0;
        std::vector<double> owned(ids.size(), 0);
        for (const std::int64_t point : seen.frames[f][k].measurement.features) {
          const int others = othersOf(seen, point, f, k, {});
          if (others == 0) continue;
          ++known;
          for (std::size_t i = 0; i + 1 < ids.size(); ++i) owned[i] += static_cast<double>(othersOf(seen, point, f, k, ids[i])) / others;
        }
        for (std::size_t i = 0; i < ids.size(); ++i)
          EXPECT_NEAR(shares[i], (owned[i] + kNeutral / 4) / (known + kNeutral), 1e-12) << f << " " << k << " " << i;
      }
    for (auto& frame : seen.decisions)  // votes of the first round are gone in the second
      for (auto& decision : frame) decision.landmark = LandmarkId{static_cast<std::int64_t>(random() % 4)};
  }
}

TEST(FeatureVotes, WithoutDecisionsSharesAreEven) {
  std::mt19937 random(4);
  const SeenPoints seen = randomSightings(random);
  FeatureVotes votes(seen.frames);
  const std::vector<LandmarkId> ids{LandmarkId{0}, LandmarkId{}};
  const auto expectEven = [&] {
    for (std::size_t f = 0; f < seen.frames.size(); ++f)
      for (std::size_t k = 0; k < seen.frames[f].size(); ++k) EXPECT_EQ(votes.shares(f, k, LandmarkId{}, ids, 3), (std::vector<double>{0.5, 0.5}));
  };
  expectEven();
  votes.count(seen.decisions);
  votes.count({});
  expectEven();
}

}  // namespace
}  // namespace roomgraph
