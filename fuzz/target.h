// SPDX-License-Identifier: BSD-3-Clause
// Fuzz targets: each gives the bytes of an input to one reader; all are linked into one program.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roomgraph::fuzz {

/// Gives any bytes to a reader. An Error, with which the program would end in one line, is an answer; every
/// other exception, a crash, a hang and a leak are findings.
using ReadBytes = void (*)(std::string_view bytes);

struct Target {
  std::string name;
  ReadBytes read;
};

/// All targets, by name.
const std::vector<Target>& targets();
/// Null when there is none of that name.
const Target* findTarget(std::string_view name);
/// Reads the bytes. Returns with which Error the reader refused them; empty when it did not.
std::string readWith(const Target& target, std::string_view bytes);

/// Adds a target when the program starts.
struct TargetRegistration {
  TargetRegistration(const char* name, ReadBytes read);
};

/// A folder for files that readers open; removed at the end. In memory where TMPDIR is.
const std::filesystem::path& scratchFolder();
/// Writes a file there.
std::filesystem::path scratchFile(const std::string& name, std::string_view bytes);

/// What stands between the parts of an input that holds several files.
inline constexpr std::string_view kPartMark = "\n=====\n";
/// Writes the parts of an input as files of these names; the last takes all that is left. A name whose part
/// is missing has no file afterwards.
void writeParts(std::string_view bytes, const std::vector<std::string>& names);

/// Ends the program when what a reader promises does not hold.
void require(bool holds, const char* promise);

}  // namespace roomgraph::fuzz

/// ROOMGRAPH_FUZZ_TARGET(name) { … } defines a target; its input is `bytes`.
#define ROOMGRAPH_FUZZ_TARGET(name)                                                        \
  static void read_##name(std::string_view bytes);                                         \
  static const roomgraph::fuzz::TargetRegistration registered_##name(#name, &read_##name); \
  static void read_##name([[maybe_unused]] std::string_view bytes)
