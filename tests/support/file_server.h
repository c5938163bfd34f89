// SPDX-License-Identifier: BSD-3-Clause
// The HTTP server of file_server.py, running as long as an object lives.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "temporary_folder.h"

namespace roomgraph::test {

/// Serves its folder on a free port of this machine.
class FileServer {
 public:
  FileServer() {
    setenv("no_proxy", "127.0.0.1", 1);  // whatever proxy a developer uses
    int to_server[2], from_server[2];
    EXPECT_EQ(pipe2(to_server, O_CLOEXEC), 0);
    EXPECT_EQ(pipe2(from_server, O_CLOEXEC), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, to_server[0], 0);
    posix_spawn_file_actions_adddup2(&actions, from_server[1], 1);
    std::vector<std::string> words{ROOMGRAPH_PYTHON, ROOMGRAPH_SOURCE_DIR "/tests/support/file_server.py",
                                   folder_.path().string(), log_.file("log").string()};
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const int error = posix_spawn(&pid_, ROOMGRAPH_PYTHON, &actions, nullptr, pointers.data(), environ);
    EXPECT_EQ(error, 0) << ROOMGRAPH_PYTHON << " cannot be started";
    posix_spawn_file_actions_destroy(&actions);
    close(to_server[0]);
    close(from_server[1]);
    input_ = to_server[1];
    for (char digit = 0; read(from_server[0], &digit, 1) == 1 && digit != '\n';) port_ += digit;
    close(from_server[0]);
  }
  ~FileServer() {
    close(input_);  // it ends
    int status = 0;
    waitpid(pid_, &status, 0);
  }
  FileServer(const FileServer&) = delete;
  FileServer& operator=(const FileServer&) = delete;

  const TemporaryFolder& folder() const { return folder_; }
  std::string host() const { return "http://127.0.0.1:" + port_; }
  /// `how`: plain, norange, half, nolength, held, damaged, redirect or refused.
  std::string base(const std::string& how) const { return host() + "/" + how; }
  /// "ADDRESS RANGE" lines, RANGE being "-" without one.
  std::string requests() const { return log_.read("log"); }

 private:
  TemporaryFolder folder_, log_;
  pid_t pid_ = -1;
  int input_ = -1;
  std::string port_;
};

}  // namespace roomgraph::test
