// SPDX-License-Identifier: BSD-3-Clause
// Blocks of zlib's file reader cut into lines.
#include "gz_lines.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

constexpr std::size_t kLongestLine = 1 << 24;  // a sweep of 100 000 readings has a tenth of that

}  // namespace

GzLines::GzLines(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw InputError(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(file)) throw InputError(file.string() + ": is not a file");
  in_ = gzopen(file.c_str(), "rb");
  if (!in_) throw InputError(file.string() + ": cannot be opened: " + std::strerror(errno));
  size_ = static_cast<double>(std::filesystem::file_size(file));
}

GzLines::~GzLines() {
  gzclose(in_);
}

bool GzLines::fill() {
  const int got = gzread(in_, block_.data(), static_cast<unsigned>(block_.size()));
  begin_ = 0;
  end_ = static_cast<std::size_t>(std::max(got, 0));
  int error = Z_OK;
  gzerror(in_, &error);
  if (error == Z_BUF_ERROR)
    problem_ = "the gzip stream is cut off";
  else if (error != Z_OK && error != Z_STREAM_END)
    problem_ = "the gzip stream is damaged";
  return end_ > 0;
}

bool GzLines::next(std::string& line) {
  line.clear();
  ended_ = false;
  for (;;) {
    if (begin_ == end_ && !fill()) break;
    const char* const from = block_.data() + begin_;
    const auto* const found = static_cast<const char*>(std::memchr(from, '\n', end_ - begin_));
    const std::size_t length = found ? static_cast<std::size_t>(found - from) : end_ - begin_;
    if (line.size() < kLongestLine) line.append(from, length);
    begin_ += length + (found ? 1 : 0);
    if (!found) continue;
    ended_ = true;
    break;
  }
  if (!ended_ && line.empty()) return false;
  ++number_;
  return true;
}

double GzLines::share() const {
  return size_ > 0 ? std::min(1.0, static_cast<double>(gzoffset(in_)) / size_) : 1;
}

}  // namespace roomgraph
