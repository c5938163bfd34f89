// SPDX-License-Identifier: BSD-3-Clause
// Loops and tasks on TBB's threads, with their order made known to ThreadSanitizer.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <utility>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace roomgraph {

/// What happened before pass() happens before what follows wait(). TBB sees to that; this tells ThreadSanitizer, which does
/// not see into a library that was not built with it. Nothing in other builds.
class Handover {
 public:
  void pass() {
#if defined(__SANITIZE_THREAD__)
    __tsan_release(this);
#endif
  }
  void wait() {
#if defined(__SANITIZE_THREAD__)
    __tsan_acquire(this);
#endif
  }
};

/// body(i) for first <= i < last, in any order and on several threads; no two may write to the same place.
template <class Index, class Body>
void parallelFor(Index first, Index last, const Body& body) {
  Handover begin, end;
  begin.pass();
  tbb::parallel_for(first, last, [&](Index i) {
    begin.wait();
    body(i);
    end.pass();
  });
  end.wait();
}

/// One task beside the caller, who must wait() for it before this is destroyed.
class TaskBeside {
 public:
  template <class Task>
  void run(Task task) {
    begin_.pass();
    group_.run([this, task = std::move(task)] {
      begin_.wait();
      task();
      end_.pass();
    });
  }
  void wait() {
    group_.wait();
    end_.wait();
  }

 private:
  Handover begin_, end_;
  tbb::task_group group_;
};

}  // namespace roomgraph
