// SPDX-License-Identifier: BSD-3-Clause
// Visitors that read and write declared parameters one by one.
#include "option_values.h"

#include <functional>
#include <optional>
#include <stdexcept>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using TextOf = std::function<std::optional<std::string>(const std::string& key)>;

// Takes each parameter's text from a source, where it has one.
class TextReader : public ParameterVisitor {
 public:
  TextReader(TextOf text_of, std::string place) : text_of_(std::move(text_of)), place_(std::move(place)) {}
  void add(std::string_view key, bool& value, const ParameterInfo& info) override { read(key, value, info); }
  void add(std::string_view key, int& value, const ParameterInfo& info) override { read(key, value, info); }
  void add(std::string_view key, double& value, const ParameterInfo& info) override {
    read(key, value, info);
  }
  void add(std::string_view key, std::string& value, const ParameterInfo& info) override {
    read(key, value, info);
  }
  void add(std::string_view key, std::vector<std::string>& value, const ParameterInfo& info) override {
    read(key, value, info);
  }

 private:
  template <class Value>
  void read(std::string_view key, Value& value, const ParameterInfo& info) {
    const auto text = text_of_(std::string(key));
    if (!text) return;
    try {
      parseParameter(*text, info, value);
    } catch (const std::invalid_argument& error) {
      throw ConfigError(place_ + " " + std::string(key) + " = " + *text + ": " + error.what());
    }
  }
  TextOf text_of_;
  std::string place_;
};

class TextWriter : public ParameterVisitor {
 public:
  std::map<std::string, std::string> values;
  void add(std::string_view key, bool& value, const ParameterInfo&) override { write(key, value); }
  void add(std::string_view key, int& value, const ParameterInfo&) override { write(key, value); }
  void add(std::string_view key, double& value, const ParameterInfo&) override { write(key, value); }
  void add(std::string_view key, std::string& value, const ParameterInfo&) override { write(key, value); }
  void add(std::string_view key, std::vector<std::string>& value, const ParameterInfo&) override {
    write(key, value);
  }

 private:
  template <class Value>
  void write(std::string_view key, const Value& value) {
    values[std::string(key)] = formatParameter(value);
  }
};

// MRPT leaves a comment behind a value in it.
std::string withoutComment(std::string text) {
  for (const char* mark : {"//", ";", "#"}) text = text.substr(0, text.find(mark));
  const auto end = text.find_last_not_of(" \t\r");
  return end == std::string::npos ? "" : text.substr(0, end + 1);
}

}  // namespace

void readOptions(const mrpt::config::CConfigFileBase& source, const std::string& section,
                 Configurable& options) {
  TextReader reader(
      [&](const std::string& key) -> std::optional<std::string> {
        if (!source.keyExists(section, key)) return std::nullopt;
        return withoutComment(source.read_string(section, key, ""));
      },
      "section " + section + ",");
  options.declareParameters(reader);
}

std::map<std::string, std::string> valuesOf(const Configurable& options) {
  TextWriter writer;
  const_cast<Configurable&>(options).declareParameters(writer);  // the writer changes nothing
  return writer.values;
}

void setValues(const std::map<std::string, std::string>& values, Configurable& options) {
  TextReader reader(
      [&](const std::string& key) -> std::optional<std::string> {
        const auto at = values.find(key);
        return at == values.end() ? std::nullopt : std::optional(at->second);
      },
      "options of the map:");
  options.declareParameters(reader);
}

void printOptions(const Configurable& options, std::ostream& out) {
  for (const auto& [key, value] : valuesOf(options)) out << key << " = " << value << "\n";
}

}  // namespace roomgraph
