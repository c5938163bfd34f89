// SPDX-License-Identifier: BSD-3-Clause
// Schema collected from parameter declarations by a visitor; Markdown tables.
#include "roomgraph/core/config_schema.h"

#include <algorithm>
#include <tuple>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

bool sameButOwners(const ConfigSchema::Key& a, const ConfigSchema::Key& b) {
  return std::tie(a.key, a.type, a.default_text, a.doc, a.unit, a.allowed) ==
         std::tie(b.key, b.type, b.default_text, b.doc, b.unit, b.allowed);
}

class Collector : public ParameterVisitor {
 public:
  Collector(std::vector<ConfigSchema::Key>& keys, const std::string& owner) : keys_(keys), owner_(owner) {}
  void add(std::string_view key, bool& value, const ParameterInfo& info) override {
    put(key, "bool", value, info);
  }
  void add(std::string_view key, int& value, const ParameterInfo& info) override {
    put(key, "int", value, info);
  }
  void add(std::string_view key, double& value, const ParameterInfo& info) override {
    put(key, "number", value, info);
  }
  void add(std::string_view key, std::string& value, const ParameterInfo& info) override {
    put(key, "text", value, info);
  }
  void add(std::string_view key, std::vector<std::string>& value, const ParameterInfo& info) override {
    put(key, "list", value, info);
  }

 private:
  template <class T>
  void put(std::string_view key, const std::string& type, const T& value, const ParameterInfo& info) {
    const ConfigSchema::Key declared{std::string(key),
                                     type,
                                     formatParameter(value),
                                     std::string(info.doc),
                                     std::string(info.unit),
                                     describeAllowed(type, info),
                                     {}};
    const auto same = std::find_if(keys_.begin(), keys_.end(), [&](const ConfigSchema::Key& known) {
      return !owner_.empty() && !known.owners.empty() && sameButOwners(known, declared);
    });
    auto& key_owners = (same == keys_.end() ? keys_.emplace_back(declared) : *same).owners;
    if (!owner_.empty()) key_owners.push_back(owner_);
  }
  std::vector<ConfigSchema::Key>& keys_;
  const std::string& owner_;
};

}  // namespace

ConfigSchema::Section& ConfigSchema::section(const std::string& name) {
  const auto found =
      std::find_if(sections_.begin(), sections_.end(), [&](const Section& s) { return s.name == name; });
  if (found != sections_.end()) return *found;
  sections_.push_back({name, "", {}});
  return sections_.back();
}

void ConfigSchema::add(const std::string& name, Configurable& source, const std::string& owner) {
  Collector collector(section(name).keys, owner);
  source.declareParameters(collector);
}

void ConfigSchema::describe(const std::string& name, const std::string& doc) {
  section(name).doc = doc;
}

void ConfigSchema::check(const Config& config) const {
  for (const auto& entry : config.entries()) {
    std::vector<std::string> names;
    for (const auto& s : sections_) names.push_back(s.name);
    const auto found = std::find(names.begin(), names.end(), entry.section);
    if (found == names.end())
      throw ConfigError(entry.place + ": unknown section [" + entry.section + "]" +
                        didYouMean(entry.section, names) + "; known sections: " + join(names));
    std::vector<std::string> keys;
    for (const auto& key : sections_[static_cast<std::size_t>(found - names.begin())].keys)
      keys.push_back(key.key);
    if (std::find(keys.begin(), keys.end(), entry.key) == keys.end())
      throw ConfigError(entry.place + ": [" + entry.section + "] has no key '" + entry.key + "' (value '" +
                        entry.value + "')" + didYouMean(entry.key, keys) + "; known keys: " + join(keys));
  }
}

std::string ConfigSchema::markdown() const {
  std::string page;
  for (const auto& s : sections_) {
    page += "## [" + s.name + "]\n" + (s.doc.empty() ? "" : s.doc + "\n");
    if (s.keys.empty()) {
      page += "\n";
      continue;
    }
    page +=
        "\n| key | default | allowed | unit | meaning | read by |\n| --- | --- | --- | --- | --- | --- |\n";
    for (const auto& key : s.keys)
      page += "| `" + key.key + "` | " + (key.default_text.empty() ? "" : "`" + key.default_text + "`") +
              " | " + key.allowed + " | " + key.unit + " | " + key.doc + " | " +
              (key.owners.empty() ? "" : "`" + join(key.owners, "`, `") + "`") + " |\n";
    page += "\n";
  }
  return page;
}

}  // namespace roomgraph
