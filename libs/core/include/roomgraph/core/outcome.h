// SPDX-License-Identifier: BSD-3-Clause
// Outcome<T>: a value, or the reason of an expected failure.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace roomgraph {

/// A value, or the reason why there is none. For expected perception failures ("lost", "no ground plane"),
/// which are normal control flow; exceptions are for broken input.
template <class T>
class Outcome {
 public:
  Outcome(T value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor): reads as a return value
  static Outcome failure(std::string reason) { return Outcome(std::nullopt, std::move(reason)); }

  explicit operator bool() const { return value_.has_value(); }
  bool ok() const { return value_.has_value(); }
  const T& operator*() const { return *value_; }
  T& operator*() { return *value_; }
  const T* operator->() const { return &*value_; }
  T* operator->() { return &*value_; }
  /// Why there is no value; empty when there is one.
  const std::string& reason() const { return reason_; }

 private:
  Outcome(std::nullopt_t, std::string reason) : reason_(std::move(reason)) {}
  std::optional<T> value_;
  std::string reason_;
};

}  // namespace roomgraph
