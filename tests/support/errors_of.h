// SPDX-License-Identifier: BSD-3-Clause
// Message of an expected exception, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace roomgraph::test {

/// The message of the exception of the given type that `action` throws; fails the test when it throws none or
/// another.
template <class Exception, class Action>
std::string messageOf(Action&& action) {
  try {
    action();
  } catch (const Exception& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another exception: " << error.what();
    return "";
  }
  ADD_FAILURE() << "no exception";
  return "";
}

}  // namespace roomgraph::test
