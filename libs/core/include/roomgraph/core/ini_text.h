// SPDX-License-Identifier: BSD-3-Clause
// INI entries with file and line, parsed strictly.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace roomgraph {

/// One "key = value" line of an INI text with its place.
struct IniEntry {
  std::string section, key, value;
  std::string place;                  ///< "config.ini:12", or "--set" for an override from the command line
  std::filesystem::path folder = {};  ///< where relative files in the value are; empty: working directory
};

/// Splits an INI text. Comments start with # or ; at the line's start or after white space, not within double
/// quotes (which stay in the value) and not in "key = #e6862a" (text attached, first in the value). MRPT's
/// reader keeps neither line numbers nor duplicates, which a strict config has to report. Throws ConfigError
/// on a line that is neither a section, an entry nor a comment, and on duplicate keys.
std::vector<IniEntry> parseIni(const std::string& text, const std::string& name);
/// Relative files in it are in the file's folder. Throws InputError when it cannot be read.
std::vector<IniEntry> parseIniFile(const std::filesystem::path& file);

}  // namespace roomgraph
