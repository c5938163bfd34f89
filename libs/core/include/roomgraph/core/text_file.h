// SPDX-License-Identifier: BSD-3-Clause
// Reading of whole text files and parsing of JSON, with errors that name the place.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {

/// The whole content of a file, which may be empty. Throws InputError naming file and cause (no such file, is
/// a folder, cannot be opened).
std::string readTextFile(const std::filesystem::path& file);

/// Parses a JSON text, `Json` being a type of nlohmann-json. Throws `Failure`: "name: is empty", or
/// "name: not valid JSON: line 3, column 7: …".
template <class Json, class Failure = InputError>
Json parseJson(const std::string& text, const std::string& name, bool with_comments = false) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw Failure(name + ": is empty");
  try {
    return Json::parse(text, nullptr, true, with_comments);
  } catch (const typename Json::exception& error) {
    throw Failure(name + ": not valid JSON: " + jsonProblem(error, text));
  }
}

}  // namespace roomgraph
