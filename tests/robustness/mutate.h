// SPDX-License-Identifier: BSD-3-Clause
// Seeded random damage to binary and text files.
#pragma once

#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace roomgraph::test {

/// Damages bytes as disks, transfers and wrong programs do; the same seed gives the same damage everywhere.
class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  /// Flipped, deleted and doubled bytes, sizes and doubles written over what was there.
  std::string binary(std::string bytes) {
    for (unsigned edits = 1 + below(3); edits > 0 && bytes.size() > 16; --edits) {
      const std::size_t at = below(bytes.size() - 12);
      switch (below(6)) {
        case 0:
          bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 << below(8)));
          break;
        case 1:
          bytes.erase(at, 1 + below(8));
          break;
        case 2:
          bytes.insert(at, bytes.substr(at, 1 + below(64)));
          break;
        case 3:
        case 4:
          overwrite(bytes, at, pick<std::uint32_t>({0xffffffff, 0x80000000, 0x7fffffff, random32(), 0}));
          break;
        default:
          overwrite(bytes, at, pick<double>({kNan, 1e12, -1e300, 1e-300, kInfinity}));
      }
    }
    return bytes;
  }

  /// Numbers replaced by what no program expects; besides all that befalls bytes.
  std::string text(std::string bytes) {
    for (unsigned edits = 1 + below(3); edits > 0 && bytes.size() > 16; --edits) {
      const std::size_t at = bytes.find_first_of("0123456789", below(bytes.size() - 12));
      if (at == std::string::npos || below(3) == 0) {
        bytes = binary(bytes);
        continue;
      }
      const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", at), bytes.size());
      bytes.replace(at, end - at,
                    pick<std::string>({"1e999", "-1e999", "nan", "-nan", "inf", "1e300", "1e12", "-1", "0",
                                       "", "4294967295", "18446744073709551616", "null", "\"x\"", "[]", "{}",
                                       "1e-320", "0x10", "9223372036854775808"}));
    }
    return bytes;
  }

 private:
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  template <class T>
  static void overwrite(std::string& bytes, std::size_t at, const T& value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  }
  template <class T>
  T pick(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }
  std::uint32_t random32() { return static_cast<std::uint32_t>(random_()); }
  // Not std::uniform_int_distribution, whose results differ between libraries.
  unsigned below(std::size_t end) { return static_cast<unsigned>(random_() % end); }

  std::mt19937 random_;
};

}  // namespace roomgraph::test
