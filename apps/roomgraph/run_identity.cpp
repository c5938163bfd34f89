// SPDX-License-Identifier: BSD-3-Clause
// Sampled bytes of the recording, checksums of everything else.
#include "run_identity.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "batch_inspector.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBytesOf =
    "bytes of ";  // names with a checksum as their value: that is nothing to show
constexpr std::uintmax_t kSamples = 64, kSampleBytes = 1 << 16;

// A recording may be many GB long: what changes it also changes its size or its time, or most of its bytes.
std::string sampledBytes(const fs::path& file, std::uintmax_t size) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::string bytes;
  std::vector<char> block(kSampleBytes);
  const std::uintmax_t last = size > kSampleBytes ? size - kSampleBytes : 0;
  for (std::uintmax_t i = 0; i < kSamples && in; ++i) {
    in.seekg(static_cast<std::streamoff>(last / (kSamples - 1) * i));
    in.read(block.data(), static_cast<std::streamsize>(std::min(size, kSampleBytes)));
    bytes.append(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (!in)
    throw InputError(file.string() + ": cannot be read" +
                     (errno ? std::string(": ") + std::strerror(errno) : ""));
  return sha256Of(bytes);
}

void addRecording(const fs::path& file, RunIdentity& out) {
  struct stat state {};
  if (stat(file.c_str(), &state) != 0) throw InputError(file.string() + ": " + std::strerror(errno));
  out.emplace_back("size of the recording", std::to_string(state.st_size) + " bytes");
  out.emplace_back("time of the recording",
                   std::to_string(state.st_mtim.tv_sec) + "." + std::to_string(state.st_mtim.tv_nsec));
  out.emplace_back(std::string(kBytesOf) + "the recording",
                   sampledBytes(file, static_cast<std::uintmax_t>(state.st_size)));
}

std::string checksumOf(const std::vector<fs::path>& files) {
  std::string all;
  for (const auto& file : files) all += sha256OfFile(file);
  return sha256Of(all);
}

std::string secondsText(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g s", seconds);
  return text;
}

std::string orNone(const std::string& text) {
  return text.empty() ? "none" : text;
}

}  // namespace

RunIdentity identityOf(const RunOptions& options, const Setup& setup) {
  RunIdentity out;
  addRecording(options.input, out);
  const RunNeeds needs = runNeedsOf(setup);
  for (const auto& [key, value] : needs.parameters) out.emplace_back(key, value);
  const std::string of = kBytesOf;
  out.emplace_back(of + "the object database", sha256Of(needs.objects));
  for (const auto& file : needs.files) out.emplace_back(of + file.string(), sha256OfFile(file));
  out.emplace_back("--from", secondsText(options.span.from_s));
  out.emplace_back("--until", secondsText(options.span.until_s));
  out.emplace_back("--map", options.map.empty() ? "none" : "given");
  out.emplace_back(of + "the earlier map", options.map.empty() ? "" : sha256OfFile(options.map));
  out.emplace_back("--record-detections", orNone(options.recording));
  out.emplace_back("--save-detections", orNone(options.detections));
  out.emplace_back(of + "the program or its libraries", checksumOf(thisProgram().parts));
  return out;
}

std::string differenceOf(const RunIdentity& before, const RunIdentity& now) {
  const auto valueIn = [](const RunIdentity& identity, const std::string& name) {
    const auto found =
        std::find_if(identity.begin(), identity.end(), [&](const auto& part) { return part.first == name; });
    return found == identity.end() ? std::optional<std::string>() : found->second;
  };
  const auto sentence = [](const std::string& name, const std::optional<std::string>& was,
                           const std::optional<std::string>& is) {
    if (name.starts_with(kBytesOf)) return name.substr(std::strlen(kBytesOf)) + " changed since";
    return name + " is " + is.value_or("not set") + " and was " + was.value_or("not set");
  };
  for (const auto& [name, value] : now)
    if (const auto was = valueIn(before, name); was != value) return sentence(name, was, value);
  for (const auto& [name, value] : before)
    if (!valueIn(now, name)) return sentence(name, value, std::nullopt);
  return "";
}

}  // namespace roomgraph
