// SPDX-License-Identifier: BSD-3-Clause
// ReadAhead: values made in order on a thread beside the one that uses them; Foreseen: what was computed
// before its turn.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace roomgraph {

/// Makes values on a thread of its own while those before them are used. The values and their order are those
/// of calls of make() one after the other: nothing depends on which thread is faster. An exception of make()
/// comes out of next() in its turn, and is the end.
template <class T>
class ReadAhead {
 public:
  /// `make` gives the next value, or nothing at the end. At most `capacity` values wait to be used; with 0
  /// there is no thread, and next() calls make().
  ReadAhead(std::function<std::optional<T>()> make, std::size_t capacity)
      : make_(std::move(make)), capacity_(capacity) {
    if (capacity_ > 0) thread_ = std::thread([this] { work(); });
  }
  /// Waits for the value that is being made.
  ~ReadAhead() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  std::optional<T> next() {
    if (capacity_ == 0) return make_();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !made_.empty() || ended_; });
    if (made_.empty()) {
      if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
      return std::nullopt;
    }
    T value = std::move(made_.front());
    made_.pop_front();
    lock.unlock();
    changed_.notify_all();
    return value;
  }

 private:
  void work() {
    std::exception_ptr failure;
    try {
      while (auto value = make_()) {
        std::unique_lock lock(mutex_);
        made_.push_back(std::move(*value));
        changed_.notify_all();
        changed_.wait(lock, [this] { return made_.size() < capacity_ || stopped_; });
        if (stopped_) return;
      }
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    failure_ = failure;
    ended_ = true;
    changed_.notify_all();
  }

  std::function<std::optional<T>()> make_;
  std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> made_;
  std::exception_ptr failure_;
  bool stopped_ = false, ended_ = false;
  std::thread thread_;  // last: it uses all of the above
};

/// Results of work on records that was done before their turn, on another thread, by time of the record.
template <class T>
class Foreseen {
 public:
  void put(double t, T value) {
    const std::lock_guard lock(mutex_);
    values_.emplace_back(t, std::move(value));
  }
  /// That of the record of time `t`, if there is one; what came before it is dropped.
  std::optional<T> take(double t) {
    const std::lock_guard lock(mutex_);
    while (!values_.empty() && values_.front().first < t) values_.pop_front();
    if (values_.empty() || values_.front().first != t) return std::nullopt;
    T value = std::move(values_.front().second);
    values_.pop_front();
    return value;
  }

 private:
  std::mutex mutex_;
  std::deque<std::pair<double, T>> values_;
};

}  // namespace roomgraph
