// SPDX-License-Identifier: BSD-3-Clause
// The database below the catalogue: statements, transactions, versions, readers beside a writer.
#include "database.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "made_up_results.h"
#include "roomgraph/catalogue/catalogue.h"
#include "roomgraph/core/errors.h"
#include "schema.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

class InDatabase : public ::testing::Test {
 protected:
  Database opened() const { return {file, Database::Mode::kReadWrite}; }
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.file("some.sqlite");
};

TEST_F(InDatabase, ValuesComeBackAsTheyWere) {
  Database database = opened();
  database.execute("CREATE TABLE t(i INTEGER, d REAL, s TEXT, n INTEGER)");
  Statement insert = database.prepare("INSERT INTO t VALUES(?, ?, ?, ?)");
  const std::string odd = std::string("a\0b", 3) + "'\"; -- Größe";
  insert.bind(std::int64_t{1} << 62, 0.1, odd, std::optional<std::int64_t>()).run();
  insert.bind(-1, -1e-300, std::string(), std::optional<std::int64_t>(7)).run();
  Statement rows = database.prepare("SELECT i, d, s, n AS last FROM t ORDER BY i DESC");
  ASSERT_EQ(rows.columns(), 4);
  EXPECT_EQ(rows.columnName(3), "last");
  ASSERT_TRUE(rows.step());
  EXPECT_EQ(rows.integer(0), std::int64_t{1} << 62);
  EXPECT_EQ(rows.number(1), 0.1);
  EXPECT_EQ(rows.text(2), odd);
  EXPECT_TRUE(rows.isNull(3));
  ASSERT_TRUE(rows.step());
  EXPECT_EQ(rows.number(1), -1e-300);
  EXPECT_EQ(rows.text(2), "");
  EXPECT_FALSE(rows.isNull(2)) << "an empty text is a text";
  EXPECT_EQ(rows.integer(3), 7);
  EXPECT_FALSE(rows.step());
}

TEST_F(InDatabase, AStatementServesAgain) {
  Database database = opened();
  database.execute("CREATE TABLE t(id INTEGER PRIMARY KEY, name TEXT UNIQUE)");
  Statement insert = database.prepare("INSERT INTO t(name) VALUES(?)");
  for (const char* name : {"a", "b"}) insert.bind(std::string(name)).run();
  EXPECT_EQ(database.lastId(), 2);
  Statement find = database.prepare("SELECT id FROM t WHERE name = ?");
  EXPECT_EQ(find.bind(std::string("b")).firstInteger(), 2);
  EXPECT_EQ(find.bind(std::string("c")).firstInteger(), std::nullopt);
  EXPECT_EQ(find.bind(std::string("a")).firstInteger(), 1);
  EXPECT_EQ(database.integer("SELECT count(*) FROM t"), 2);
  EXPECT_EQ(database.integer("SELECT id FROM t WHERE id > 99"), 0);
}

TEST_F(InDatabase, FaultsNameTheFileAndTheCause) {
  Database database = opened();
  database.execute("CREATE TABLE t(id INTEGER PRIMARY KEY)");
  const auto problem = [](const auto& action) { return messageOf<RunError>(action); };
  EXPECT_THAT(problem([&] { database.prepare("SELECT x FROM t"); }),
              ::testing::AllOf(HasSubstr("some.sqlite"), HasSubstr("no such column")));
  EXPECT_THAT(problem([&] { database.execute("INSERT INTO nowhere VALUES(1)"); }), HasSubstr("nowhere"));
  Statement insert = database.prepare("INSERT INTO t VALUES(?)");
  insert.bind(1).run();
  EXPECT_THAT(problem([&] { insert.bind(1).run(); }), HasSubstr("UNIQUE"));
  EXPECT_NO_THROW(insert.bind(2).run()) << "after a fault";
  EXPECT_EQ(database.integer("SELECT count(*) FROM t"), 2);
}

TEST_F(InDatabase, WhatIsNotCommittedIsNotThere) {
  Database database = opened();
  database.execute("CREATE TABLE t(id INTEGER PRIMARY KEY)");
  {
    const Transaction left(database);
    database.execute("INSERT INTO t VALUES(1)");
  }
  EXPECT_EQ(database.integer("SELECT count(*) FROM t"), 0);
  Transaction kept(database);
  database.execute("INSERT INTO t VALUES(2)");
  kept.commit();
  EXPECT_EQ(Database(file, Database::Mode::kReadOnly).integer("SELECT id FROM t"), 2);
}

TEST_F(InDatabase, AReaderWritesNothing) {
  opened().execute("CREATE TABLE t(id INTEGER)");
  Database reader(file, Database::Mode::kReadOnly);
  EXPECT_THAT(messageOf<RunError>([&] { reader.execute("INSERT INTO t VALUES(1)"); }), HasSubstr("readonly"));
}

class CatalogueFile : public InDatabase {
 protected:
  void SetUp() override { Catalogue::forWriting(file).import(madeUpResult("lab", 1, "default"), "first"); }
  std::string refusal() const {
    return messageOf<InputError>([&] { Catalogue::forReading(file); });
  }
};

TEST_F(CatalogueFile, IsWholeAndRefersToNothingMissing) {
  const Database database(file, Database::Mode::kReadOnly);
  Statement check = database.prepare("PRAGMA integrity_check");
  ASSERT_TRUE(check.step());
  EXPECT_EQ(check.text(0), "ok");
  EXPECT_FALSE(database.prepare("PRAGMA foreign_key_check").step());
  Statement mode = database.prepare("PRAGMA journal_mode");
  ASSERT_TRUE(mode.step());
  EXPECT_EQ(mode.text(0), "wal") << "readers do not wait for the writer";
}

TEST_F(CatalogueFile, OfAnotherVersionSaysHowToMakeItAnew) {
  opened().execute("PRAGMA user_version = 99");
  EXPECT_THAT(refusal(), HasSubstr("version 99"));
  EXPECT_THAT(refusal(), HasSubstr("batch import"));
  EXPECT_THAT(messageOf<RunError>([&] { Catalogue::forWriting(file); }), HasSubstr("version 99"))
      << "and is not written over";
}

TEST_F(CatalogueFile, OfAnotherProgramIsLeftAlone) {
  opened().execute("PRAGMA application_id = 5");
  EXPECT_THAT(refusal(), HasSubstr("no catalogue of runs"));
  EXPECT_NE(messageOf<RunError>([&] { Catalogue::forWriting(file); }), "");
}

TEST_F(CatalogueFile, IsReadWhileSomeoneWrites) {
  Database writer = opened();
  Transaction writing(writer);
  writer.execute("UPDATE runs SET status = 'failed'");
  EXPECT_EQ(Catalogue::forReading(file).runs().at(0).status, "complete") << "as it was before";
  writing.commit();
  EXPECT_EQ(Catalogue::forReading(file).runs().at(0).status, "failed");
}

// A full disk in the middle of a run's rows, as far as the database is concerned.
TEST_F(CatalogueFile, ARunIsTakenInWholeOrNotAtAll) {
  opened().execute(
      "CREATE TRIGGER full BEFORE INSERT ON files BEGIN SELECT RAISE(ABORT, 'the disk is full'); END");
  RunResult again = madeUpResult("lab", 1, "default");
  again.figures = {{"objects.f1", 0.75}};
  RunResult other = madeUpResult("hall", 2, "default");
  Catalogue catalogue = Catalogue::forWriting(file);
  for (const RunResult& result : {again, other})
    EXPECT_THAT(messageOf<RunError>([&] { catalogue.import(result, "second"); }), HasSubstr("disk is full"));
  const auto runs = catalogue.runs();
  ASSERT_EQ(runs.size(), 1u);
  ASSERT_EQ(catalogue.figure("objects.f1").size(), 1u);
  EXPECT_EQ(catalogue.figure("objects.f1")[0].value, 0.5);
  EXPECT_EQ(catalogue.failuresOf(runs[0].id).size(), 1u);
}

}  // namespace
}  // namespace roomgraph::test
