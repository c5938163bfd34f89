// SPDX-License-Identifier: BSD-3-Clause
// Parameter visitors that read INI entries and write current values; completion of relative file names.
#include "roomgraph/core/config.h"

#include <algorithm>
#include <stdexcept>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

std::string inFolder(const std::filesystem::path& folder, const std::string& file) {
  return file.empty() ? file : (folder / file).lexically_normal().string();
}

void completeFiles(const std::filesystem::path& folder, std::string& file) {
  file = inFolder(folder, file);
}
void completeFiles(const std::filesystem::path& folder, std::vector<std::string>& files) {
  for (auto& file : files) file = inFolder(folder, file);
}
template <class Number>
void completeFiles(const std::filesystem::path&, Number&) {}

class Reader : public ParameterVisitor {
 public:
  Reader(const std::vector<IniEntry>& entries, const std::string& section)
      : entries_(entries), section_(section) {}
  void add(std::string_view key, bool& value, const ParameterInfo& info) override { parse(key, value, info); }
  void add(std::string_view key, int& value, const ParameterInfo& info) override { parse(key, value, info); }
  void add(std::string_view key, double& value, const ParameterInfo& info) override {
    parse(key, value, info);
  }
  void add(std::string_view key, std::string& value, const ParameterInfo& info) override {
    parse(key, value, info);
  }
  void add(std::string_view key, std::vector<std::string>& value, const ParameterInfo& info) override {
    parse(key, value, info);
  }

 private:
  template <class T>
  void parse(std::string_view key, T& value, const ParameterInfo& info) {
    for (const auto& entry : entries_) {
      if (entry.section != section_ || entry.key != key) continue;
      try {
        parseParameter(entry.value, info, value);
        if (info.file) completeFiles(entry.folder, value);
      } catch (const std::invalid_argument& allowed) {
        throw ConfigError(entry.place + ": [" + section_ + "] " + entry.key + " = '" + entry.value +
                          "' is not allowed; allowed: " + allowed.what());
      }
    }
  }
  const std::vector<IniEntry>& entries_;
  const std::string& section_;
};

class Writer : public ParameterVisitor {
 public:
  std::vector<std::pair<std::string, std::string>> lines;
  void add(std::string_view key, bool& value, const ParameterInfo&) override { put(key, value); }
  void add(std::string_view key, int& value, const ParameterInfo&) override { put(key, value); }
  void add(std::string_view key, double& value, const ParameterInfo&) override { put(key, value); }
  void add(std::string_view key, std::string& value, const ParameterInfo&) override { put(key, value); }
  void add(std::string_view key, std::vector<std::string>& value, const ParameterInfo&) override {
    put(key, value);
  }

 private:
  template <class T>
  void put(std::string_view key, const T& value) {
    lines.emplace_back(std::string(key), formatParameter(value));
  }
};

}  // namespace

Config Config::fromFile(const std::filesystem::path& file) {
  return Config(parseIniFile(file));
}

Config Config::fromText(const std::string& text, const std::string& name) {
  return Config(parseIni(text, name));
}

void Config::override(const std::string& assignment) {
  const auto equals = assignment.find('=');
  const auto dot = assignment.find('.');
  if (equals == std::string::npos || dot == std::string::npos || dot == 0 || dot + 1 >= equals)
    throw ConfigError("--set " + assignment + ": expected section.key=value");
  IniEntry entry{assignment.substr(0, dot), assignment.substr(dot + 1, equals - dot - 1),
                 assignment.substr(equals + 1), "--set", std::filesystem::current_path()};
  std::erase_if(entries_,
                [&](const IniEntry& e) { return e.section == entry.section && e.key == entry.key; });
  entries_.push_back(std::move(entry));
}

void Config::read(const std::string& section, Configurable& target) const {
  Reader reader(entries_, section);
  target.declareParameters(reader);
}

std::string Config::text(const std::string& section, const std::string& key,
                         const std::string& fallback) const {
  std::string value = fallback;
  Reader(entries_, section).add(key, value, {.doc = ""});
  return value;
}

std::vector<std::pair<std::string, std::string>> currentValues(Configurable& source) {
  Writer writer;
  source.declareParameters(writer);
  return writer.lines;
}

}  // namespace roomgraph
