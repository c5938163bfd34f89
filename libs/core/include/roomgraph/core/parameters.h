// SPDX-License-Identifier: BSD-3-Clause
// Declaration of parameters by visitors; conversion of values from and to text.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace roomgraph {

/// What is declared about a parameter besides its key and its default (the member's initial value).
struct ParameterInfo {
  std::string_view doc;        ///< one sentence, with the meaning of special values
  std::string_view unit;       ///< "m", "rad", "s", "px" …; empty: dimensionless
  double min = -std::numeric_limits<double>::infinity();  ///< smallest allowed value, inclusive
  double max = std::numeric_limits<double>::infinity();   ///< largest allowed value, inclusive
  std::vector<std::string_view> choices = {};             ///< allowed texts; empty: any
  bool file = false;  ///< names files: relative ones are completed by the place of the entry
};

/// Walks over declared parameters. Reading a config, checking it, writing the effective one and generating
/// its documentation are all visitors of the same single declaration.
class ParameterVisitor {
 public:
  virtual ~ParameterVisitor() = default;
  virtual void add(std::string_view key, bool& value, const ParameterInfo& info) = 0;
  virtual void add(std::string_view key, int& value, const ParameterInfo& info) = 0;
  virtual void add(std::string_view key, double& value, const ParameterInfo& info) = 0;
  virtual void add(std::string_view key, std::string& value, const ParameterInfo& info) = 0;
  /// In a file: items separated by commas; one that holds a comma is in double quotes.
  virtual void add(std::string_view key, std::vector<std::string>& value, const ParameterInfo& info) = 0;
};

/// Base of classes with parameters.
class Configurable {
 public:
  virtual ~Configurable() = default;
  /// Declares every parameter once: key, member (holding the default) and what is known about it.
  virtual void declareParameters(ParameterVisitor& visitor) { (void)visitor; }
};

/// Text of a value as it stands in an INI file, in double quotes where it would not come back otherwise, and
/// back. parse throws std::invalid_argument with what is allowed.
std::string formatParameter(bool value);
std::string formatParameter(int value);
std::string formatParameter(double value);
std::string formatParameter(const std::string& value);
std::string formatParameter(const std::vector<std::string>& value);
void parseParameter(const std::string& text, const ParameterInfo& info, bool& value);
void parseParameter(const std::string& text, const ParameterInfo& info, int& value);
void parseParameter(const std::string& text, const ParameterInfo& info, double& value);
void parseParameter(const std::string& text, const ParameterInfo& info, std::string& value);
void parseParameter(const std::string& text, const ParameterInfo& info, std::vector<std::string>& value);

/// Human words for what a parameter accepts: "a number in [0, 1]", "one of a, b", …
std::string describeAllowed(std::string_view type, const ParameterInfo& info);

}  // namespace roomgraph
