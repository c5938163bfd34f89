// SPDX-License-Identifier: BSD-3-Clause
// fork and exec; wait4 for the costs; /proc for the memory of groups.
#include "child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

// In the child: only what is allowed between fork and exec.
[[noreturn]] void become(char* const* words, const char* log, bool own_group, pid_t parent) {
  if (own_group) setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // it died before
  if (!own_group) std::signal(SIGTERM, SIG_IGN);  // first: the queue may send it now
  for (const int number : {SIGINT, SIGHUP, SIGPIPE, SIGCHLD}) std::signal(number, SIG_DFL);
  if (own_group) std::signal(SIGTERM, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int in = open("/dev/null", O_RDONLY), out = open(log, O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (in >= 0) dup2(in, 0);
  if (out >= 0) {
    dup2(out, 1);
    dup2(out, 2);
  }
  execv(words[0], words);
  _exit(127);
}

constexpr int kNotTold = 126;  // exit code of a child of which nothing is known

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& log,
                           bool own_group) {
  std::vector<std::string> texts = command;
  std::vector<char*> words;
  for (auto& text : texts) words.push_back(text.data());
  words.push_back(nullptr);
  const pid_t parent = getpid();
  std::signal(SIGCHLD, SIG_DFL);  // where it is ignored, nobody is told how a child ended
  const std::string log_name = log.string();
  pid_ = fork();
  if (pid_ < 0) throw RunError(command.front() + ": cannot be started: " + std::strerror(errno));
  if (pid_ == 0) become(words.data(), log_name.c_str(), own_group, parent);
  if (own_group) setpgid(pid_, pid_);  // both do it: whoever comes first
}

ChildProcess::~ChildProcess() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::optional<ChildEnd> ChildProcess::ended() {
  if (end_) return end_;
  int status = 0;
  rusage used{};
  const pid_t pid = wait4(pid_, &status, WNOHANG, &used);
  if (pid == 0 || (pid < 0 && errno == EINTR)) return std::nullopt;
  pid_ = 0;
  if (pid < 0)
    end_ = {kNotTold, 0, 0};
  else
    end_ = {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            seconds(used.ru_utime) + seconds(used.ru_stime), static_cast<double>(used.ru_maxrss) / 1024};
  return end_;
}

void ChildProcess::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

double memoryOfGroups(const std::vector<pid_t>& groups) {
  double pages = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename().string();
    if (!std::isdigit(static_cast<unsigned char>(name[0]))) continue;
    std::ifstream in(entry.path() / "stat");
    std::string text;
    std::getline(in, text);
    const auto end = text.rfind(')');  // of the name, which may hold anything
    int parent = 0, group = 0;
    if (end == std::string::npos || std::sscanf(text.c_str() + end + 1, " %*c %d %d", &parent, &group) != 2)
      continue;
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) continue;
    long size = 0, resident = 0;
    std::ifstream(entry.path() / "statm") >> size >> resident;
    pages += static_cast<double>(resident);
  }
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace roomgraph
