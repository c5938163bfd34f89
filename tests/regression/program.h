// SPDX-License-Identifier: BSD-3-Clause
// The built program started from a test, with its output and exit code.
#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

namespace roomgraph::test {

inline std::string contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// What a call of the program left behind.
struct CallResult {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out, err;
};

/// The environment with these variables ("NAME=value", or "NAME=" for none) in it, for a child. Without one
/// of its own the model folder is below `folder`: a developer's networks do not take part in tests.
inline std::vector<std::string> environmentWith(const std::filesystem::path& folder,
                                                const std::vector<std::string>& variables) {
  std::map<std::string, std::string> values;
  const auto add = [&values](const std::string& entry) {
    const auto equals = entry.find('=');
    values[entry.substr(0, equals)] = equals == std::string::npos ? "" : entry.substr(equals + 1);
  };
  for (char** entry = environ; *entry; ++entry) add(*entry);
  add("XDG_DATA_HOME=" + (folder / "data_home").string());
  for (const auto& variable : variables) add(variable);
  std::vector<std::string> out;
  for (const auto& [name, value] : values)
    if (!value.empty()) out.push_back(name + "=" + value);
  return out;
}

/// The built executable, started with arguments; its output goes to files in `folder`.
class Program {
 public:
  Program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
          const std::filesystem::path& working_directory = std::filesystem::current_path(),
          const std::vector<std::string>& variables = {})
      : folder_(folder) {
    std::vector<std::string> words{ROOMGRAPH_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    auto environment = environmentWith(folder, variables);
    const auto pointersTo = [](std::vector<std::string>& texts) {
      std::vector<char*> pointers;
      for (auto& text : texts) pointers.push_back(text.data());
      pointers.push_back(nullptr);
      return pointers;
    };
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const auto redirect = [&](int descriptor, const char* name) {
      posix_spawn_file_actions_addopen(&actions, descriptor, (folder_ / name).c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0644);
    };
    redirect(1, "stdout.txt");
    redirect(2, "stderr.txt");
    posix_spawn_file_actions_addchdir_np(&actions, working_directory.c_str());
    // Tests may themselves run under nohup, and an ignored signal stays ignored in children.
    sigset_t ended_by;
    sigemptyset(&ended_by);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ended_by, signal);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &ended_by);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int error = posix_spawn(&pid_, ROOMGRAPH_PROGRAM, &actions, &attributes, pointersTo(words).data(),
                                  pointersTo(environment).data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    // No test may go on: whoever kills process -1 kills all there are.
    if (error != 0) throw std::system_error(error, std::generic_category(), ROOMGRAPH_PROGRAM " cannot be started");
  }

  pid_t pid() const { return pid_; }
  CallResult wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentOf(folder_ / "stdout.txt"),
            contentOf(folder_ / "stderr.txt")};
  }

 private:
  std::filesystem::path folder_;
  pid_t pid_ = -1;
};

inline CallResult call(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                       const std::filesystem::path& working_directory = std::filesystem::current_path(),
                       const std::vector<std::string>& variables = {}) {
  return Program(folder, arguments, working_directory, variables).wait();
}

/// The contract of every failure: its exit code, and one line on stderr that begins with the program's name.
inline void expectOneLine(const CallResult& outcome, int exit_code,
                          const ::testing::Matcher<const std::string&>& message) {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
  const auto lines = linesOf(outcome.err);
  ASSERT_EQ(lines.size(), 1u) << outcome.err;
  EXPECT_TRUE(lines[0].starts_with("roomgraph: ")) << lines[0];
  EXPECT_THAT(lines[0], message);
}

}  // namespace roomgraph::test
