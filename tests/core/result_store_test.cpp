// SPDX-License-Identifier: BSD-3-Clause
// JournalledResults: what a repeated run gets back, and when it computes again.
#include "roomgraph/core/result_store.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "errors_of.h"
#include "memory_limit.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

constexpr double kSync_s = 30;

/// A run of "computations": step i takes the square root of i, and of everything before.
class ResultStoreTest : public ::testing::Test {
 protected:
  double step(ResultStore* store, int i) {
    return recalled(
        store, "root", i, [&] { return ++computed, std::sqrt(i); },
        [](double value) { return std::string(reinterpret_cast<const char*>(&value), sizeof value); },
        [](const std::string& bytes) {
          double value = 0;
          std::memcpy(&value, bytes.data(), sizeof value);
          return value;
        });
  }
  /// The sum of steps [0, count), and how many of them were computed.
  std::pair<double, int> run(ResultStore* store, int count) {
    double sum = 0;
    computed = 0;
    for (int i = 0; i < count; ++i) sum += step(store, i);
    return {sum, computed};
  }
  static double sumOfRoots(int count) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += std::sqrt(i);
    return sum;
  }

  test::TemporaryFolder folder;
  const std::filesystem::path file = folder.file("results");
  int computed = 0;
};

TEST_F(ResultStoreTest, WithoutAStoreEverythingIsComputed) {
  EXPECT_EQ(run(nullptr, 5), std::make_pair(sumOfRoots(5), 5));
}

TEST_F(ResultStoreTest, ARepeatedRunComputesOnlyWhatIsNew) {
  {
    JournalledResults store(file, "key", kSync_s);
    EXPECT_TRUE(store.empty());
    EXPECT_EQ(run(&store, 5), std::make_pair(sumOfRoots(5), 5));
    EXPECT_FALSE(store.empty());
  }
  {
    JournalledResults store(file, "key", kSync_s);
    EXPECT_EQ(store.found().results, 5);
    EXPECT_EQ(run(&store, 8), std::make_pair(sumOfRoots(8), 3));
  }
  JournalledResults third(file, "key", kSync_s);
  EXPECT_EQ(run(&third, 8), std::make_pair(sumOfRoots(8), 0));
  EXPECT_FALSE(third.diverged());
}

TEST_F(ResultStoreTest, ARunThatIsKilledWhileItRecallsLosesNothing) {
  {
    JournalledResults store(file, "key", kSync_s);
    run(&store, 5);
  }
  {
    JournalledResults store(file, "key", kSync_s);
    EXPECT_EQ(run(&store, 2).second, 0);
  }
  JournalledResults store(file, "key", kSync_s);
  EXPECT_EQ(run(&store, 5).second, 0);
}

TEST_F(ResultStoreTest, FromTheFirstResultOfSomethingElseOnItComputes) {
  {
    JournalledResults store(file, "key", kSync_s);
    run(&store, 5);
  }
  {
    JournalledResults store(file, "key", kSync_s);
    EXPECT_EQ(run(&store, 2).second, 0);
    EXPECT_FALSE(store.recall("boxes", 2)) << "the next is a root";
    EXPECT_TRUE(store.diverged());
    store.keep("boxes", 2, "a box");
    EXPECT_FALSE(store.recall("root", 2)) << "what was behind it is no longer believed";
  }
  JournalledResults store(file, "key", kSync_s);
  EXPECT_EQ(store.found().results, 3);
  EXPECT_EQ(run(&store, 2).second, 0);
  EXPECT_EQ(store.recall("boxes", 2), "a box");
}

TEST_F(ResultStoreTest, TheTimeIsPartOfTheName) {
  {
    JournalledResults store(file, "key", kSync_s);
    store.keep("root", 1, "of one");
  }
  JournalledResults store(file, "key", kSync_s);
  EXPECT_FALSE(store.recall("root", std::nextafter(1, 2)));
}

TEST_F(ResultStoreTest, AfterStopAndWithoutIntervalNothingIsKept) {
  {
    JournalledResults store(file, "key", kSync_s);
    run(&store, 3);
    store.stop();
    EXPECT_EQ(run(&store, 4).second, 4);
  }
  {
    JournalledResults store(file, "key", 0);
    EXPECT_EQ(run(&store, 5), std::make_pair(sumOfRoots(5), 2)) << "recalled are those before stop()";
  }
  EXPECT_EQ(JournalledResults(file, "key", kSync_s).found().results, 3);
}

TEST_F(ResultStoreTest, ADamagedEndIsTold) {
  {
    JournalledResults store(file, "key", kSync_s);
    run(&store, 3);
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  JournalledResults store(file, "key", kSync_s);
  EXPECT_EQ(store.found().results, 2);
  EXPECT_GT(store.found().damaged, 8u);
  EXPECT_EQ(run(&store, 3), std::make_pair(sumOfRoots(3), 1));
}

TEST(Results, NumbersThroughBytesAreTheSameBits) {
  const std::vector<double> numbers{0.1, -0.0, 1e-310, std::numeric_limits<double>::infinity(), 1 / 3.0};
  const std::vector<double> back = numbersFrom(bytesOfNumbers(numbers));
  ASSERT_EQ(back.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(back[i], numbers[i]);
    EXPECT_EQ(std::signbit(back[i]), std::signbit(numbers[i]));
  }
  EXPECT_TRUE(numbersFrom(bytesOfNumbers(std::vector<double>())).empty());
  EXPECT_THROW(numbersFrom("half a number"), std::invalid_argument);
}

// Sound checksums, but bytes that are no result: only a file that somebody has changed.
TEST_F(ResultStoreTest, AResultThatCannotBeDecodedIsAnInputError) {
  {
    JournalledResults store(file, "key", kSync_s);
    store.keep("numbers", 12.5, "half a number");
  }
  JournalledResults store(file, "key", kSync_s);
  const auto recall = [&] {
    recalled(&store, "numbers", 12.5, [] { return std::vector<double>{1}; }, bytesOfNumbers, numbersFrom);
  };
  EXPECT_EQ(test::messageOf<InputError>(recall),
            "checkpoint: its result 'numbers' of second 12.500000 is damaged: not a whole number of numbers");
}

TEST(Results, ADamagedLengthDoesNotFillTheMemory) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "this sanitizer ends the program at such a size";
  const auto decode = [](const std::string&) { return std::vector<char>(std::size_t{1} << 33).size(); };
  EXPECT_THROW(decodedResult("boxes", 1, "some bytes", decode), InputError);
}

}  // namespace
}  // namespace roomgraph
