// SPDX-License-Identifier: BSD-3-Clause
// Declared parameters from and to MRPT's configurations and archives.
#pragma once

#include <mrpt/config/CConfigFileBase.h>

#include <map>
#include <ostream>
#include <string>

#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// Sets what the section has of the declared keys; the rest keeps its value. Throws ConfigError naming
/// section, key and what is allowed.
void readOptions(const mrpt::config::CConfigFileBase& source, const std::string& section,
                 Configurable& options);

/// Key -> text of the value, which gives the same value again.
std::map<std::string, std::string> valuesOf(const Configurable& options);

/// Sets what is among the values; keys that are not declared are of another version and are passed over.
void setValues(const std::map<std::string, std::string>& values, Configurable& options);

/// "key = value" lines.
void printOptions(const Configurable& options, std::ostream& out);

}  // namespace roomgraph
