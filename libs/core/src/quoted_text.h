// SPDX-License-Identifier: BSD-3-Clause
// Quoting of texts and list items in INI values.
#pragma once

#include <string>
#include <vector>

namespace roomgraph {

/// Place after the closing quote of the text in double quotes that begins at `begin`; npos: it is not closed.
std::size_t endOfQuoted(const std::string& text, std::size_t begin);

/// The text in double quotes, with \" \\ \n for a quote, a backslash and a new line, when it would not come
/// back from an INI file as it is; else the text. `in_list`: as an item of a list, where more has a meaning.
std::string quotedWhenNeeded(const std::string& text, bool in_list);

/// What a text stands for: itself unless it begins with a double quote. Throws std::invalid_argument when
/// it does and the quotes are not closed at its end, or hold an unknown \x.
std::string unquoted(const std::string& text);

/// Items of a list, separated by commas and without the blanks around them; empty ones count only in quotes.
/// Throws like unquoted().
std::vector<std::string> listItems(const std::string& text);

}  // namespace roomgraph
