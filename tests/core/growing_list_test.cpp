// SPDX-License-Identifier: BSD-3-Clause
// List that only grows: against a vector, copies that part, threads, the life of its elements.
#include "roomgraph/core/growing_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <random>
#include <string>
#include <thread>

namespace roomgraph {
namespace {

using GrowingTexts = GrowingList<std::string>;

void expectSame(const GrowingTexts& list, const std::vector<std::string>& expected) {
  ASSERT_EQ(list.size(), expected.size());
  EXPECT_EQ(list.empty(), expected.empty());
  EXPECT_TRUE(std::equal(list.begin(), list.end(), expected.begin(), expected.end()));
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(list[i], expected[i]);
  if (expected.empty()) return;
  EXPECT_EQ(list.front(), expected.front());
  EXPECT_EQ(list.back(), expected.back());
}

// Lists and vectors beside them are copied, replaced and added to at random.
TEST(GrowingList, HoldsWhatAVectorWould) {
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  std::vector<GrowingTexts> lists(4);
  std::vector<std::vector<std::string>> vectors(4);
  for (int step = 0; step < 300; ++step) {
    const std::size_t a = below(4), b = below(4);
    if (step % 3 == 0) {
      lists[a] = GrowingTexts(lists[b]);
      vectors[a] = std::vector(vectors[b]);
    }
    const std::size_t count = below(100);
    for (std::size_t i = 0; i < count; ++i) {
      const std::string text = "a text that is too long to lie within its object " + std::to_string(random());
      lists[a].push_back(text);
      vectors[a].push_back(text);
    }
  }
  std::size_t longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    expectSame(lists[i], vectors[i]);
    longest = std::max(longest, lists[i].size());
  }
  EXPECT_GT(longest, 600u) << "several chunks";
}

TEST(GrowingList, IsSearchedLikeAVector) {
  GrowingList<int> list;
  for (int i = 0; i < 1000; ++i) list.push_back(2 * i);
  const auto found = std::lower_bound(list.begin(), list.end(), 1001);
  EXPECT_EQ(*found, 1002);
  EXPECT_EQ(found - list.begin(), 501);
  EXPECT_EQ(*std::prev(found), 1000);
  EXPECT_EQ(list.begin()[7], 14);
  EXPECT_LT(list.begin(), found);
  EXPECT_EQ(std::accumulate(list.begin(), list.end(), 0), 999 * 1000);
}

TEST(GrowingList, ElementsDoNotMoveAndCopiesShareThem) {
  GrowingList<int> list;
  list.push_back(1);
  const int* first = &list.front();
  for (int i = 0; i < 1000; ++i) list.push_back(i);
  EXPECT_EQ(&list.front(), first);
  const GrowingList<int> copy = list;
  EXPECT_EQ(&copy.front(), first);
  EXPECT_EQ(&copy.back(), &list.back());
}

TEST(GrowingList, WhatWasMovedFromIsEmptyAndOfUse) {
  GrowingList<int> list{1, 2, 3};
  GrowingList<int> taken = std::move(list);
  EXPECT_TRUE(list.empty());  // NOLINT: that is what is asked
  list.push_back(4);
  EXPECT_EQ(list.back(), 4);
  EXPECT_EQ(list.size(), 1u);
  EXPECT_EQ(taken.size(), 3u);
  list = std::move(taken);
  EXPECT_EQ(list.back(), 3);
  EXPECT_TRUE(taken.empty());  // NOLINT
}

struct Thrower {
  static inline int left = 0;
  explicit Thrower(int of) : value(of) {
    if (left-- == 0) throw std::bad_alloc();
  }
  int value;
};

// At the beginning of a chunk, within it, and where another list has gone on.
TEST(GrowingList, StaysAsItWasWhereAnElementCannotBeMade) {
  for (const int count : {0, 7, 256, 300}) {
    GrowingList<Thrower> list;
    Thrower::left = 10000;
    for (int i = 0; i < count; ++i) list.emplace_back(i);
    GrowingList<Thrower> copy = list;
    copy.emplace_back(-1);
    for (auto* of : {&list, &copy}) {
      const std::size_t before = of->size();
      Thrower::left = 0;
      EXPECT_THROW(of->emplace_back(5), std::bad_alloc);
      Thrower::left = 10000;
      EXPECT_EQ(of->size(), before);
      of->emplace_back(6);
      EXPECT_EQ(of->back().value, 6);
      for (int i = 0; i < count; ++i) ASSERT_EQ((*of)[static_cast<std::size_t>(i)].value, i);
    }
  }
}

TEST(GrowingList, AnElementOfItsOwnIsAdded) {
  GrowingList<std::string> list{"a text that is too long to lie within its object"};
  {
    GrowingList<std::string> copy = list;
    copy.push_back("another");
  }
  list.emplace_back(list.front());
  EXPECT_EQ(list.back(), list.front());
}

struct Counted {
  static inline int alive = 0;
  Counted() { ++alive; }
  Counted(const Counted&) { ++alive; }
  ~Counted() { --alive; }
};

TEST(GrowingList, ElementsLiveAsLongAsAListHoldsThem) {
  {
    GrowingList<Counted> list;
    for (int i = 0; i < 300; ++i) list.push_back({});
    EXPECT_EQ(Counted::alive, 300);
    GrowingList<Counted> copy = list;
    EXPECT_EQ(Counted::alive, 300);
    list.push_back({});
    copy.push_back({});  // its own beginning of the last chunk
    EXPECT_EQ(Counted::alive, 301 + 44 + 1);
    list = {};
    EXPECT_EQ(Counted::alive, 256 + 44 + 1);
  }
  EXPECT_EQ(Counted::alive, 0);
}

// What one thread reads of a copy another one does not touch when it goes on.
TEST(GrowingList, ACopyIsReadWhileTheListGrows) {
  GrowingList<std::string> list;
  for (int i = 0; i < 300; ++i) list.push_back(std::to_string(i));
  const GrowingList<std::string> copy = list;
  bool same = true;
  std::thread reader([&] {
    for (int round = 0; round < 200; ++round)
      for (std::size_t i = 0; i < copy.size(); ++i) same = same && copy[i] == std::to_string(i);
  });
  for (int i = 0; i < 5000; ++i) list.push_back("more");
  reader.join();
  EXPECT_TRUE(same);
  EXPECT_EQ(copy.size(), 300u);
  EXPECT_EQ(list.size(), 5300u);
}

}  // namespace
}  // namespace roomgraph
