// SPDX-License-Identifier: BSD-3-Clause
// fetchNetwork() against a server that behaves and misbehaves, and against folders.
#include "roomgraph/models/fetch.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <thread>

#include "errors_of.h"
#include "file_server.h"
#include "made_up_network.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/models/model_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// Remembers what it was told; cancels when so many bytes are there.
struct Listener : FetchListener {
  void started(const KnownFile& file) override { log += "start " + file.name + "\n"; }
  void progressed(std::uint64_t bytes) override { now = bytes; }
  void finished(const KnownFile& file, bool was_there) override {
    log += (was_there ? "there " : "fetched ") + file.name + "\n";
  }
  bool cancelled() const override { return now >= stop_at; }

  std::string log;
  std::uint64_t now = 0, stop_at = ~0ull;
};

class Fetch : public ::testing::Test {
 protected:
  Fetch() { server.folder().write("net.onnx", content); }
  void fetch(const std::string& from = "") { fetchNetwork(network, models, from, listener); }
  std::string atPlace() const { return read(place); }
  static std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Nothing, not even an empty folder, is left of a fetch.
  void expectNoTrace() const { EXPECT_FALSE(fs::exists(place.parent_path())); }
  void leavePart(const std::string& bytes) {
    fs::create_directories(place.parent_path());
    std::ofstream(part, std::ios::binary) << bytes;
  }

  const std::string content = noise(400000);
  FileServer server;
  TemporaryFolder folder;
  fs::path models = folder.file("models"), place = models / "net" / "net.onnx",
           part = models / "net" / "net.onnx.part";
  KnownNetwork network =
      known({"net", "objects", "collection", {{"net.onnx", content}}, server.base("plain")});
  Listener listener;
};

TEST_F(Fetch, DownloadsFromThePublishedAddress) {
  fetch();
  EXPECT_TRUE(atPlace() == content);
  EXPECT_FALSE(fs::exists(part));
  EXPECT_EQ(server.requests(), "/plain/net.onnx -\n");
  EXPECT_EQ(listener.log, "start net.onnx\nfetched net.onnx\n");
  EXPECT_EQ(listener.now, content.size());
  fetch();
  EXPECT_EQ(server.requests(), "/plain/net.onnx -\n") << "it is there";
  EXPECT_THAT(listener.log, ::testing::EndsWith("there net.onnx\n"));
}

TEST_F(Fetch, FollowsARedirection) {
  fetch(server.base("redirect"));
  EXPECT_TRUE(atPlace() == content);
  EXPECT_THAT(server.requests(), HasSubstr("/plain/net.onnx -"));
}

TEST_F(Fetch, GoesOnAfterABrokenTransfer) {
  for (const char* how : {"half", "nolength"}) {
    EXPECT_THAT(
        messageOf<InputError>([&] { fetch(server.base(how)); }),
        AllOf(HasSubstr(server.base(how) + "/net.onnx: "), HasSubstr("200000 of 400000 bytes are kept")));
    EXPECT_FALSE(fs::exists(place));
    EXPECT_FALSE(isInstalled(network, models));
    EXPECT_TRUE(read(part) == content.substr(0, 200000));
    fetch(server.base(how));
    EXPECT_THAT(server.requests(), ::testing::EndsWith("/net.onnx bytes=200000-\n"));
    EXPECT_TRUE(atPlace() == content) << how;
    EXPECT_FALSE(fs::exists(part));
    fs::remove(place);
  }
}

TEST_F(Fetch, BeginsAnewWhenTheServerKnowsNoRanges) {
  leavePart(content.substr(0, 1000));
  fetch(server.base("norange"));
  EXPECT_EQ(server.requests(), "/norange/net.onnx bytes=1000-\n");
  EXPECT_TRUE(atPlace() == content);
}

TEST_F(Fetch, ACompletePartNeedsNoServer) {
  leavePart(content);
  fetch();
  EXPECT_EQ(server.requests(), "");
  EXPECT_TRUE(atPlace() == content);
}

TEST_F(Fetch, APartThatIsTooLongIsForgotten) {
  leavePart(content + "more");
  fetch();
  EXPECT_TRUE(atPlace() == content);
}

TEST_F(Fetch, AWrongChecksumLeavesNothing) {
  EXPECT_THAT(messageOf<RunError>([&] { fetch(server.base("damaged")); }),
              AllOf(HasSubstr("/damaged/net.onnx: has the SHA-256 "), HasSubstr(network.files[0].sha256),
                    HasSubstr("nothing was kept")));
  expectNoTrace();
  leavePart("something else");
  EXPECT_THAT(messageOf<RunError>([&] { fetch(); }), HasSubstr("SHA-256"))
      << "the beginning is of another file";
  expectNoTrace();
}

TEST_F(Fetch, AFileOfAnotherSizeLeavesNothing) {
  server.folder().write("net.onnx", content + "x");
  EXPECT_THAT(messageOf<RunError>([&] { fetch(); }), HasSubstr("larger than the 400000 bytes"));
  expectNoTrace();
  server.folder().write("net.onnx", "short");
  EXPECT_THAT(messageOf<RunError>([&] { fetch(); }), HasSubstr("has 5 bytes instead of the 400000"));
  expectNoTrace();
  leavePart(content.substr(0, 1000));
  EXPECT_THAT(messageOf<RunError>([&] { fetch(); }), HasSubstr("has 5 bytes instead of the 400000"))
      << "longer than what the server has";
  expectNoTrace();
}

TEST_F(Fetch, WhatTheServerRefusesIsNamed) {
  EXPECT_THAT(messageOf<InputError>([&] { fetch(server.base("refused")); }),
              HasSubstr("/refused/net.onnx: the server answers 403"));
  fs::remove(server.folder().file("net.onnx"));
  EXPECT_THAT(messageOf<InputError>([&] { fetch(); }),
              AllOf(HasSubstr("net.onnx: there is no such file"), HasSubstr("/plain/net.onnx")));
  expectNoTrace();
}

TEST_F(Fetch, UnreachableServers) {
  EXPECT_THAT(messageOf<InputError>([&] { fetch("http://127.0.0.1:1/x"); }),
              AllOf(HasSubstr("http://127.0.0.1:1/x/net.onnx: "), HasSubstr("onnect")));
  expectNoTrace();
  leavePart(content.substr(0, 1000));
  EXPECT_THAT(messageOf<InputError>([&] { fetch("http://127.0.0.1:1/x"); }),
              HasSubstr("1000 of 400000 bytes"));
  EXPECT_TRUE(read(part) == content.substr(0, 1000));
}

TEST_F(Fetch, LooksInSubfoldersOfAnAddress) {
  fs::create_directory(server.folder().file("collection"));
  fs::rename(server.folder().file("net.onnx"), server.folder().file("collection") / "net.onnx");
  fetch(server.base("plain") + "/");
  EXPECT_EQ(server.requests(), "/plain/net.onnx -\n/plain/collection/net.onnx -\n");
  EXPECT_TRUE(atPlace() == content);
}

TEST_F(Fetch, LooksFurtherWhereItIsRefused) {
  fs::create_directory(server.folder().file("collection"));
  fs::rename(server.folder().file("net.onnx"), server.folder().file("collection") / "net.onnx");
  fetch(server.base("refused"));
  EXPECT_EQ(server.requests(), "/refused/net.onnx -\n/refused/collection/net.onnx -\n");
  EXPECT_TRUE(atPlace() == content);
}

TEST_F(Fetch, CopiesFromAFolder) {
  for (const char* below : {"", "collection", "net"}) {
    TemporaryFolder source;
    fs::create_directories(source.file(below));
    std::ofstream(source.file(below) / "net.onnx", std::ios::binary) << content;
    leavePart("of another attempt");
    fetch(source.path().string());
    EXPECT_TRUE(atPlace() == content) << below;
    fs::remove_all(models);
  }
  EXPECT_EQ(server.requests(), "");
}

TEST_F(Fetch, FoldersWithoutTheFileOrWithAnother) {
  TemporaryFolder source;
  EXPECT_THAT(messageOf<InputError>([&] { fetch(source.path().string()); }),
              AllOf(HasSubstr("no such file"), HasSubstr(source.file("collection/net.onnx").string())));
  EXPECT_THAT(messageOf<InputError>([&] { fetch("/nowhere/at/all"); }),
              HasSubstr("/nowhere/at/all: no such folder"));
  source.write("net.onnx", "short");
  EXPECT_THAT(messageOf<RunError>([&] { fetch(source.path().string()); }), HasSubstr("has 5 bytes"));
  source.write("net.onnx", std::string(content.size(), 'x'));
  EXPECT_THAT(messageOf<RunError>([&] { fetch(source.path().string()); }), HasSubstr("SHA-256"));
  expectNoTrace();
}

TEST_F(Fetch, SourcesThatAreNone) {
  EXPECT_THAT(messageOf<ConfigError>([&] { fetch("ftp://x.org/y"); }), HasSubstr("begins with http"));
  network.files[0].url = "";
  EXPECT_THAT(messageOf<ConfigError>([&] { fetch(); }),
              AllOf(HasSubstr("net.onnx is published nowhere"), HasSubstr("--from")));
  EXPECT_FALSE(fs::exists(models));
}

TEST_F(Fetch, LabelsOfTheCatalogueAreWritten) {
  network.files.push_back({"labels.txt", 6, sha256Of("chair\n"), "", "chair\n"});
  fetch();
  EXPECT_EQ(read(models / "net" / "labels.txt"), "chair\n");
  EXPECT_EQ(server.requests(), "/plain/net.onnx -\n");
}

TEST_F(Fetch, ADamagedFileIsReplaced) {
  std::string damaged = content;
  damaged[7] ^= 1;
  fs::create_directories(place.parent_path());
  std::ofstream(place, std::ios::binary) << damaged;
  EXPECT_THROW(fetch(server.base("refused")), InputError);
  EXPECT_TRUE(atPlace() == damaged) << "until there is a better one";
  fetch();
  EXPECT_TRUE(atPlace() == content);
}

TEST_F(Fetch, CancelledItKeepsWhatCame) {
  listener.stop_at = 1;
  EXPECT_THAT(messageOf<Interrupted>([&] { fetch(server.base("held")); }),
              AllOf(HasSubstr("interrupted"), HasSubstr("bytes are kept")));
  const std::string kept = read(part);
  EXPECT_LT(kept.size(), content.size());
  EXPECT_TRUE(content.starts_with(kept) && !kept.empty());
  listener.stop_at = ~0ull;
  fetch();
  EXPECT_THAT(server.requests(), HasSubstr("/plain/net.onnx bytes=" + std::to_string(kept.size()) + "-"));
  EXPECT_TRUE(atPlace() == content);
}

TEST_F(Fetch, OfTwoAtOnceOneIsToldOfTheOther) {
  std::thread held([&] {
    Listener other;
    fetchNetwork(network, models, server.base("held"), other);
  });
  while (!fs::exists(part)) std::this_thread::yield();
  EXPECT_THAT(messageOf<RunError>([&] { fetch(); }), HasSubstr("net: another process is fetching it"));
  server.folder().write("release", "");
  held.join();
  EXPECT_TRUE(atPlace() == content);
  fetch();
  EXPECT_EQ(listener.log, "there net.onnx\n");
}

TEST_F(Fetch, AFolderThatCannotBeMade) {
  models = "/proc/roomgraph_models";  // not even the administrator's
  EXPECT_THAT(messageOf<RunError>([&] { fetch(); }),
              AllOf(HasSubstr("/proc/roomgraph_models"), HasSubstr("cannot be made")));
  models = folder.write("file", "");
  EXPECT_THAT(messageOf<RunError>([&] { fetch(); }), HasSubstr("cannot be made"));
}

// As on a full disk: writing fails in the middle.
TEST_F(Fetch, ADiskThatTakesNoMore) {
  rlimit former{};
  getrlimit(RLIMIT_FSIZE, &former);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100000, former.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = messageOf<RunError>([&] { fetch(); });
  setrlimit(RLIMIT_FSIZE, &former);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, AllOf(HasSubstr("cannot write"), HasSubstr("net.onnx.part"), HasSubstr("too large")));
  EXPECT_FALSE(fs::exists(place));
  fetch();
  EXPECT_TRUE(atPlace() == content) << "what could be written is continued";
}

}  // namespace
}  // namespace roomgraph::test
