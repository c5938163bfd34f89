// SPDX-License-Identifier: BSD-3-Clause
// Lines of a text file, plain or gzipped.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

struct gzFile_s;

namespace roomgraph {

class GzLines {
 public:
  /// Throws InputError naming file and cause.
  explicit GzLines(const std::filesystem::path& file);
  ~GzLines();
  GzLines(const GzLines&) = delete;
  GzLines& operator=(const GzLines&) = delete;

  /// False at the end of the file, or of what can be read of it.
  bool next(std::string& line);
  std::size_t number() const { return number_; }  ///< of the line, from 1
  double share() const;                           ///< of the file that was read, in [0, 1]
  bool ended() const { return ended_; }           ///< the last line had its end
  /// Why reading ended before the file's end; empty when it did not.
  const std::string& problem() const { return problem_; }

 private:
  bool fill();

  gzFile_s* in_;
  double size_;
  std::array<char, 1 << 16> block_;
  std::size_t begin_ = 0, end_ = 0, number_ = 0;
  bool ended_ = true;
  std::string problem_;
};

}  // namespace roomgraph
