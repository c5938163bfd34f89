// SPDX-License-Identifier: BSD-3-Clause
// Exception types of the program and their exit codes.
#pragma once

#include <stdexcept>
#include <string>

namespace roomgraph {

/// Base of all errors that the program reports in one line; the exit code is part of the command line's
/// contract.
struct Error : std::runtime_error {
  Error(const std::string& what, int code) : std::runtime_error(what), exit_code(code) {}
  int exit_code;
};

/// The run failed (output not writable, nothing could be computed). Exit code 1.
struct RunError : Error {
  explicit RunError(const std::string& what) : Error(what, 1) {}
};

/// Wrong usage or configuration. Exit code 2.
struct ConfigError : Error {
  explicit ConfigError(const std::string& what) : Error(what, 2) {}
};

/// An input file is missing, unreadable or not what it should be. Exit code 3.
struct InputError : Error {
  explicit InputError(const std::string& what) : Error(what, 3) {}
};

/// Ended by a signal before all was done; what was written covers what was done. Exit code 4.
struct Interrupted : Error {
  explicit Interrupted(const std::string& what) : Error(what, 4) {}
};

}  // namespace roomgraph
