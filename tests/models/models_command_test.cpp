// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph models` as its users call it: tables, exit codes, one line per error, proxies, Ctrl-C.
#include <thread>

#include "file_server.h"
#include "made_up_network.h"
#include "program.h"

namespace roomgraph::test {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

class ModelsCommand : public ::testing::Test {
 protected:
  ModelsCommand() {
    server.folder().write("net.onnx", content);
    server.folder().write("door.onnx", "door");
    catalogue =
        folder.write("networks.json",
                     catalogueText({{"net", "objects", "net", {{"net.onnx", content}}, server.base("plain")},
                                    {"doors", "doors", "doors", {{"door.onnx", "door"}}}}));
  }
  std::vector<std::string> words(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "models");
    arguments.insert(arguments.end(), {"--catalogue", catalogue.string(), "--models", models.string()});
    return arguments;
  }
  CallResult run(const std::vector<std::string>& arguments, const std::vector<std::string>& variables = {}) {
    return call(folder.path(), words(arguments), folder.path(), variables);
  }

  const std::string content = noise(300000);
  FileServer server;
  TemporaryFolder folder;
  fs::path catalogue, models = folder.file("models"), place = models / "net" / "net.onnx";
};

TEST_F(ModelsCommand, FetchPathCheckList) {
  expectOneLine(run({"path", "net"}), 1,
                AllOf(HasSubstr("net: not installed"), HasSubstr("models fetch net")));
  const CallResult fetched = run({"fetch", "net"});
  EXPECT_EQ(fetched.exit_code, 0) << fetched.err;
  EXPECT_EQ(fetched.out, "net: " + place.string() + "\n");
  EXPECT_EQ(fetched.err, "net.onnx: 300000 bytes, checksum right\n") << "a plain line per file";
  EXPECT_TRUE(contentOf(place) == content);
  EXPECT_EQ(run({"path", "net"}).out, place.string() + "\n");
  const CallResult check = run({"check"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_EQ(check.out, "net: sizes and checksums are right\n");
  const auto lines = linesOf(run({"list"}).out);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_THAT(lines[1], AllOf(::testing::StartsWith("net "), HasSubstr("chair"), HasSubstr(place.string())));
  EXPECT_THAT(lines[2], AllOf(::testing::StartsWith("doors "), HasSubstr("no (needs --from)")));
}

TEST_F(ModelsCommand, ListAsJsonAndInDetail) {
  ASSERT_EQ(run({"fetch", "net", "--quiet"}).err, "");
  const fs::path file = folder.file("list.json");
  const CallResult listed = run({"list", "net", "--json", file.string()});
  EXPECT_THAT(listed.out,
              AllOf(HasSubstr("BSD-3-Clause"), HasSubstr("300000 bytes"), HasSubstr(server.base("plain"))));
  EXPECT_THAT(listed.out, Not(HasSubstr("door.onnx")));
  const json networks = json::parse(contentOf(file)).at("networks");
  ASSERT_EQ(networks.size(), 2u);
  EXPECT_EQ(networks[0].at("path"), place.string());
  EXPECT_EQ(networks[0].at("installed"), true);
  EXPECT_EQ(networks[1].at("installed"), false);
  EXPECT_EQ(networks[1].at("files")[0].at("bytes"), 4);
}

TEST_F(ModelsCommand, CheckNamesWhatIsWrong) {
  EXPECT_THAT(run({"check"}).out, HasSubstr("no network in " + models.string()));
  ASSERT_EQ(run({"fetch", "net", "doors", "--from", server.folder().path().string()}).exit_code, 0);
  std::fstream(place, std::ios::in | std::ios::out | std::ios::binary) << "X";
  const CallResult check = run({"check"});
  expectOneLine(check, 1, AllOf(HasSubstr("net;"), HasSubstr("models fetch net")));
  EXPECT_THAT(linesOf(check.out),
              ElementsAre(HasSubstr("net.onnx: has the SHA-256"), "doors: sizes and checksums are right"));
  EXPECT_EQ(run({"check", "doors"}).exit_code, 0);
  fs::resize_file(place, 10);
  EXPECT_THAT(run({"check", "net"}).out, HasSubstr("has 10 bytes instead of 300000"));
  EXPECT_EQ(run({"path", "net"}).exit_code, 1) << "a half file is not offered";
  fs::remove_all(models / "doors");
  EXPECT_EQ(run({"check", "doors"}).exit_code, 1) << "asked for by name, and not there";
}

TEST_F(ModelsCommand, EachFailureHasItsExitCode) {
  expectOneLine(run({"fetch", "nte"}), 2, AllOf(HasSubstr("'nte'"), HasSubstr("did you mean 'net'")));
  expectOneLine(run({"fetch", "doors"}), 2, HasSubstr("--from"));
  expectOneLine(run({"fetch", "net", "--from", "gopher://x"}), 2, HasSubstr("gopher://x"));
  expectOneLine(run({"fetch"}), 2, HasSubstr("NAME"));
  expectOneLine(call(folder.path(), {"models"}), 2, HasSubstr("Usage: roomgraph models"));
  expectOneLine(run({"fetch", "net", "--from", "/nowhere"}), 3, HasSubstr("/nowhere"));
  expectOneLine(run({"fetch", "net", "--from", "http://127.0.0.1:1"}), 3,
                HasSubstr("http://127.0.0.1:1/net.onnx"));
  expectOneLine(run({"fetch", "net", "--from", server.base("refused")}), 3, HasSubstr("403"));
  expectOneLine(run({"fetch", "net", "--from", server.base("plain/none")}), 3, HasSubstr("no such file"));
  expectOneLine(run({"fetch", "net", "--from", server.base("half")}), 3, HasSubstr("150000 of 300000"));
  expectOneLine(run({"fetch", "net", "--from", server.base("damaged")}), 1, HasSubstr("SHA-256"));
  EXPECT_FALSE(fs::exists(place));
  models = "/proc/none";
  expectOneLine(run({"fetch", "net"}), 1, HasSubstr("cannot be made"));
  catalogue = folder.write("bad.json", "{}");
  expectOneLine(run({"list"}), 2, HasSubstr("bad.json"));
}

TEST_F(ModelsCommand, TheFolderIsTheUsers) {
  const fs::path data = folder.file("data");
  const std::vector<std::string> path{"models", "path", "net", "--catalogue", catalogue.string()},
      fetch{"models", "fetch", "net", "--catalogue", catalogue.string()};
  ASSERT_EQ(call(folder.path(), fetch, folder.path(), {"XDG_DATA_HOME=" + data.string()}).exit_code, 0);
  EXPECT_TRUE(fs::exists(data / "roomgraph/models/net/net.onnx"));
  expectOneLine(call(folder.path(), path, folder.path(), {"XDG_DATA_HOME=", "HOME="}), 2,
                HasSubstr("--models"));
  const CallResult home = call(folder.path(), path, folder.path(), {"XDG_DATA_HOME=", "HOME=/ann"});
  expectOneLine(home, 1, HasSubstr("/ann/.local/share/roomgraph/models"));
}

TEST_F(ModelsCommand, ProxiesOfTheEnvironment) {
  const std::string elsewhere = "http://models.invalid/plain";
  const CallResult direct = run({"fetch", "net", "--from", elsewhere}, {"http_proxy="});
  expectOneLine(direct, 3, HasSubstr("models.invalid"));
  const CallResult proxied =
      run({"fetch", "net", "--from", elsewhere}, {"http_proxy=" + server.host(), "no_proxy="});
  EXPECT_EQ(proxied.exit_code, 0) << proxied.err;
  EXPECT_EQ(server.requests(), elsewhere + "/net.onnx -\n") << "asked with the whole address";
  EXPECT_TRUE(contentOf(place) == content);
  fs::remove_all(models);
  const CallResult excepted =
      run({"fetch", "net", "--from", elsewhere}, {"http_proxy=" + server.host(), "no_proxy=models.invalid"});
  EXPECT_EQ(excepted.exit_code, 3) << "not by the proxy";
}

TEST_F(ModelsCommand, CtrlCKeepsWhatCame) {
  Program held(folder.path(), words({"fetch", "net", "--from", server.base("held")}));
  const fs::path part = place.string() + ".part";
  std::error_code none;
  while (!fs::exists(part, none) || fs::file_size(part, none) == 0) std::this_thread::yield();
  kill(held.pid(), SIGINT);
  const CallResult ended = held.wait();
  EXPECT_EQ(ended.exit_code, 4) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("bytes are kept"));
  EXPECT_FALSE(fs::exists(place));
  const auto kept = fs::file_size(part);
  EXPECT_EQ(run({"fetch", "net"}).exit_code, 0);
  EXPECT_THAT(server.requests(), HasSubstr("/plain/net.onnx bytes=" + std::to_string(kept) + "-"));
  EXPECT_TRUE(contentOf(place) == content);
}

TEST_F(ModelsCommand, TwoFetchesAtOnce) {
  TemporaryFolder other;
  Program first(other.path(), words({"fetch", "net", "--from", server.base("held")}));
  while (!fs::exists(place.string() + ".part")) std::this_thread::yield();
  expectOneLine(run({"fetch", "net"}), 1, HasSubstr("net: another process is fetching it"));
  server.folder().write("release", "");
  const CallResult ended = first.wait();
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_TRUE(contentOf(place) == content);
  EXPECT_EQ(run({"fetch", "net"}).err, "") << "it is there";
}

TEST_F(ModelsCommand, HelpHasExamples) {
  for (const char* command : {"list", "fetch", "check", "path"}) {
    const CallResult help = call(folder.path(), {"models", command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, AllOf(HasSubstr("Example"), HasSubstr(std::string("roomgraph models ") + command)));
  }
}

}  // namespace
}  // namespace roomgraph::test
