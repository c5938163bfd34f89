// SPDX-License-Identifier: BSD-3-Clause
// Removal of MRPT's call stack and JSON tags from messages; line and column of a JSON error.
#include "roomgraph/core/error_text.h"

#include <algorithm>

namespace roomgraph {
namespace {

std::string placeIn(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(offset);
  const auto before = text.rfind('\n', offset);
  return "line " + std::to_string(1 + std::count(text.begin(), end, '\n')) + ", column " +
         std::to_string(before == std::string::npos ? offset + 1 : offset - before);
}

}  // namespace

std::string firstLine(const std::exception& error) {
  std::string text = error.what();
  // MRPT: "Message:  <text>\nLocation: …", the cause last, or plain text.
  if (const auto message = text.rfind("Message:"); message != std::string::npos)
    text = text.substr(message + 8);
  text.erase(0, text.find_first_not_of(" \t\n"));
  text = text.substr(0, text.find('\n'));
  if (const auto tag = text.find("] "); text.starts_with("[json.exception.") && tag != std::string::npos)
    text.erase(0, tag + 2);
  return text.empty() ? "unknown error" : text;
}

std::string jsonProblem(const std::exception& error, const std::string& text) {
  constexpr const char* kAt = "parse error at ";
  constexpr const char* kOverflow = "number overflow parsing '";
  std::string problem = firstLine(error);
  if (problem.starts_with(kAt)) problem.erase(0, std::string(kAt).size());
  if (problem.starts_with(kOverflow)) {
    std::string number = problem.substr(std::string(kOverflow).size());
    number = number.substr(0, number.find('\''));
    const auto offset = std::min(text.find(number), text.size());
    problem = placeIn(text, offset) + ": the number " + number + " is too large";
  }
  const bool one_line = text.find_last_not_of(" \t\r\n") < text.find('\n');
  if (one_line && problem.starts_with("line 1, ")) problem.erase(0, std::string("line 1, ").size());
  return problem;
}

}  // namespace roomgraph
