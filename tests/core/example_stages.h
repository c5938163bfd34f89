// SPDX-License-Identifier: BSD-3-Clause
// Example interface with two implementations for registry and configuration tests.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/core/stage.h"

namespace roomgraph {

/// An interface with two implementations, for tests of the registry and of the configuration.
class Greeter : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(Greeter)
 public:
  virtual std::string greet() const = 0;
};

class PoliteGreeter : public Greeter {
  DEFINE_MRPT_OBJECT(PoliteGreeter, roomgraph)
 public:
  void declareParameters(ParameterVisitor& v) override {
    v.add("loud", loud, {.doc = "says it louder"});
    v.add("times", times, {.doc = "how often", .min = 1, .max = 5});
    v.add("pause_s", pause_s, {.doc = "between two greetings", .unit = "s", .min = 0});
    v.add("language", language, {.doc = "in which language", .choices = {"en", "de"}});
    v.add("names", names, {.doc = "whom"});
  }
  std::string greet() const override { return "good day"; }

  bool loud = false;
  int times = 2;
  double pause_s = 0.5;
  std::string language = "en";
  std::vector<std::string> names = {"Ann", "Bob"};
};

class CurtGreeter : public Greeter {
  DEFINE_MRPT_OBJECT(CurtGreeter, roomgraph)
 public:
  std::string greet() const override { return "hi"; }
};

}  // namespace roomgraph
