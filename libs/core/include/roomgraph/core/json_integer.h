// SPDX-License-Identifier: BSD-3-Clause
// Integers of JSON files, of any of nlohmann-json's types.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

namespace roomgraph {

/// A JSON number as an integer. Throws the library's type_error for what is no number, has a fraction or does not fit:
/// its own get<int>() makes something of these without a word.
template <class Integer, class Json>
Integer integerOf(const Json& value) {
  static_assert(std::is_integral_v<Integer>);
  using Limits = std::numeric_limits<Integer>;
  const auto fail = [&] { throw Json::type_error::create(302, "type must be an integer in range, but is " + value.dump(), &value); };
  if (value.is_number_unsigned()) {
    const auto number = value.template get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(Limits::max())) fail();
    return static_cast<Integer>(number);
  }
  if (value.is_number_integer()) {
    const auto number = value.template get<std::int64_t>();
    if (!std::in_range<Integer>(number)) fail();
    return static_cast<Integer>(number);
  }
  if (!value.is_number()) fail();
  const double number = value.template get<double>();
  // The limit of 64 bits is no double; the power of two beyond it is.
  const double end = std::ldexp(1.0, Limits::digits);
  if (!(number == std::floor(number)) || number >= end || number < (std::is_signed_v<Integer> ? -end : 0.0)) fail();
  return static_cast<Integer>(number);
}

/// The same of an object's member; `fallback` when it has none.
template <class Integer, class Json>
Integer integerOf(const Json& object, const char* key, Integer fallback) {
  const auto found = object.find(key);
  return found == object.end() ? fallback : integerOf<Integer>(*found);
}

}  // namespace roomgraph
