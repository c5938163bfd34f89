// SPDX-License-Identifier: BSD-3-Clause
// yaml-cpp's nodes with checks and messages.
#include "yaml_place.h"

#include <set>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {

std::string YamlPlace::place() const {
  const YAML::Mark mark = node_.Mark();
  return mark.line >= 0 ? file_ + ":" + std::to_string(mark.line + 1) : file_;
}

void YamlPlace::fail(const std::string& problem) const {
  throw ConfigError(place() + ": " + (key_.empty() ? "" : key_ + ": ") + problem);
}

std::vector<std::pair<std::string, YamlPlace>> YamlPlace::entries(
    const std::vector<std::string>& known) const {
  if (!node_.IsMap()) fail("is to be a map with keys of " + join(known));
  std::vector<std::pair<std::string, YamlPlace>> out;
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const YamlPlace name(entry.first, file_, key_);
    const std::string key = name.text();
    if (std::find(known.begin(), known.end(), key) == known.end())
      name.fail("unknown key '" + key + "'" + didYouMean(key, known) + "; known: " + join(known));
    if (!seen.insert(key).second) name.fail("key '" + key + "' stands here twice");
    out.emplace_back(key, YamlPlace(entry.second, file_, key_.empty() ? key : key_ + "." + key));
  }
  return out;
}

std::vector<YamlPlace> YamlPlace::items() const {
  if (!node_.IsSequence()) return {*this};
  std::vector<YamlPlace> out;
  for (std::size_t i = 0; i < node_.size(); ++i)
    out.emplace_back(node_[i], file_, key_ + "[" + std::to_string(i + 1) + "]");
  return out;
}

std::string YamlPlace::text() const {
  if (!node_.IsScalar()) fail("is to be one value");
  return node_.Scalar();
}

std::vector<std::string> YamlPlace::texts() const {
  std::vector<std::string> out;
  for (const auto& item : items()) out.push_back(item.text());
  return out;
}

int YamlPlace::wholeNumber() const {
  int number = 0;
  if (!node_.IsScalar() || !YAML::convert<int>::decode(node_, number) || number < 0)
    fail("is to be a whole number, 0 or more");
  return number;
}

bool YamlPlace::yesOrNo() const {
  bool value = false;
  if (!node_.IsScalar() || !YAML::convert<bool>::decode(node_, value)) fail("is to be true or false");
  return value;
}

YamlPlace readYaml(const std::string& file) {
  const std::string text = readTextFile(file);
  try {
    return {YAML::Load(text), file, ""};
  } catch (const YAML::Exception& error) {
    throw ConfigError(file + ":" + std::to_string(error.mark.line + 1) + ": not valid YAML: " + error.msg);
  }
}

}  // namespace roomgraph
