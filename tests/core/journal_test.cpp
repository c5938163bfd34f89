// SPDX-License-Identifier: BSD-3-Clause
// Journal: round trip, every truncation, every changed byte, full disks.
#include "roomgraph/core/journal.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using Records = std::vector<std::string>;

class JournalTest : public ::testing::Test {
 protected:
  static constexpr const char* kKey = "run 7";

  /// Writes the records and returns where in the file each of them ends, the title first.
  std::vector<std::size_t> write(const Records& some) {
    std::vector<std::size_t> ends;
    Journal journal(file, kKey);
    for (const auto& record : some) {
      journal.append(record);
      if (ends.empty()) ends.push_back(journal.bytes() - record.size() - 24);
      ends.push_back(journal.bytes());
    }
    return ends;
  }
  Records read(const std::string& key = kKey) {
    Journal journal(file, key);
    return rest(journal);
  }
  static Records rest(Journal& journal) {
    Records out;
    while (auto record = journal.next()) out.push_back(std::move(*record));
    return out;
  }
  static Records first(const Records& all, std::size_t count) {
    return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
  }
  /// How many records end at or before that byte.
  static std::size_t wholeBefore(const std::vector<std::size_t>& ends, std::size_t byte) {
    std::size_t count = 0;
    while (count + 1 < ends.size() && ends[count + 1] <= byte) ++count;
    return count;
  }

  test::TemporaryFolder folder;
  const std::filesystem::path file = folder.file("results.journal");
  const Records records{"first", "", std::string("\0\xff\n zero and newline", 20), std::string(300, 'x'),
                        "last"};
};

TEST_F(JournalTest, GivesBackWhatWasWrittenAndIsContinued) {
  write(first(records, 3));
  {
    Journal journal(file, kKey);
    EXPECT_THAT(rest(journal), ElementsAreArray(first(records, 3)));
    EXPECT_EQ(journal.damagedBytes(), 0u);
    journal.append(records[3]);
    journal.sync();
    journal.append(records[4]);
  }
  EXPECT_THAT(read(), ElementsAreArray(records));
}

TEST_F(JournalTest, WhatWasNotReadIsReplaced) {
  write(records);
  {
    Journal journal(file, kKey);
    journal.next();
    journal.next();
    journal.append("other");
  }
  EXPECT_THAT(read(), ElementsAreArray(Records{"first", "", "other"}));
  {
    Journal journal(file, kKey);
    journal.next();
    journal.next();
    journal.unread();
    journal.append("again");
  }
  EXPECT_THAT(read(), ElementsAreArray(Records{"first", "again"}));
}

// A power cut leaves a file of any length.
TEST_F(JournalTest, AfterEveryTruncationTheWholeRecordsAreReadAndContinued) {
  const auto ends = write(records);
  const std::string whole = folder.read("results.journal");
  ASSERT_EQ(whole.size(), ends.back());
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    folder.write("results.journal", whole.substr(0, length));
    Records expected = first(records, wholeBefore(ends, length));
    {
      Journal journal(file, kKey);
      ASSERT_THAT(rest(journal), ElementsAreArray(expected)) << "cut to " << length << " bytes";
      const std::size_t sound = length < ends[0] ? 0 : ends[expected.size()];
      ASSERT_EQ(journal.damagedBytes(), length - sound) << "cut to " << length << " bytes";
      journal.append("next");
    }
    expected.push_back("next");
    ASSERT_THAT(read(), ElementsAreArray(expected)) << "cut to " << length << " bytes";
  }
}

TEST_F(JournalTest, NoRecordFromAChangedByteOnIsBelieved) {
  const auto ends = write(records);
  const std::string whole = folder.read("results.journal");
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const char change : {'\x01', '\x80'}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      folder.write("results.journal", damaged);
      // The title is of no record: without it there are none.
      const std::size_t sound = at < ends[0] ? 0 : wholeBefore(ends, at);
      ASSERT_THAT(read(), ElementsAreArray(first(records, sound))) << "byte " << at;
    }
}

TEST_F(JournalTest, RecordsInAnotherPlaceAreNotBelieved) {
  const Records three{"aaaa", "bbbb", "cccc"};
  const auto ends = write(three);
  const std::string whole = folder.read("results.journal");
  const auto part = [&](std::size_t i) { return whole.substr(ends[i], ends[i + 1] - ends[i]); };
  folder.write("results.journal", whole.substr(0, ends[1]) + part(2) + part(1));
  EXPECT_THAT(read(), ElementsAreArray(first(three, 1))) << "changed places";
  folder.write("results.journal", whole.substr(0, ends[1]) + part(0) + part(1) + part(2));
  EXPECT_THAT(read(), ElementsAreArray(first(three, 1))) << "one came twice";
}

TEST_F(JournalTest, BelongsToItsKey) {
  write(records);
  EXPECT_TRUE(read("run 8").empty());
  EXPECT_EQ(read().size(), records.size()) << "looking does no harm";
}

TEST_F(JournalTest, AnotherFileIsNone) {
  folder.write("results.journal", "a letter, much longer than the title of a journal is\n");
  EXPECT_TRUE(read().empty());
}

TEST_F(JournalTest, OnAFullDiskTheRecordsBeforeStay) {
  std::string message;
  {
    const auto former_handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit former{};
    getrlimit(RLIMIT_FSIZE, &former);
    const rlimit limit{1000, former.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    Journal journal(file, kKey);
    journal.append("small");
    message = test::messageOf<RunError>([&] { journal.append(std::string(2000, 'x')); });
    EXPECT_NO_THROW(journal.append("small again")) << "the half record is out of the way";
    setrlimit(RLIMIT_FSIZE, &former);
    std::signal(SIGXFSZ, former_handler);
  }
  EXPECT_THAT(message, HasSubstr("cannot write " + file.string() + ": File too large"));
  EXPECT_THAT(read(), ElementsAreArray(Records{"small", "small again"}));
  EXPECT_THAT(test::messageOf<RunError>([] { Journal("/dev/full", kKey).append("x"); }),
              HasSubstr("No space left on device"));
}

TEST_F(JournalTest, CannotBeWhereThereIsNoFolder) {
  EXPECT_THAT(test::messageOf<RunError>([&] { Journal(folder.file("none/results.journal"), kKey); }),
              HasSubstr("No such file or directory"));
}

}  // namespace
}  // namespace roomgraph
