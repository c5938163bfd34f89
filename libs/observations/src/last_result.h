// SPDX-License-Identifier: BSD-3-Clause
// Keeps the last result of a pure function of a text.
#pragma once

#include <optional>
#include <string>

namespace roomgraph {

/// Of a function that is called with the same text again and again (a particle filter asks each particle
/// about the same observation): makes the value when the text is another one than last time. One for each
/// thread.
template <class Value>
class LastResult {
 public:
  template <class Make>
  const Value& of(const std::string& text, Make make) {
    if (!value_ || text != text_) {
      value_ = make(text);
      text_ = text;
    }
    return *value_;
  }

 private:
  std::string text_;
  std::optional<Value> value_;
};

}  // namespace roomgraph
