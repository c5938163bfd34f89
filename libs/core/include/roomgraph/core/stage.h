// SPDX-License-Identifier: BSD-3-Clause
// Stage: common base of the exchangeable pipeline steps chosen by class name.
#pragma once

#include <mrpt/rtti/CObject.h>

#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// Base of every exchangeable step of the pipeline. An interface derives from it with one verb over plain
/// structs; implementations are registered with MRPT's class factory and chosen by class name in config.ini.
class Stage : public mrpt::rtti::CObject, public Configurable {
  DEFINE_VIRTUAL_MRPT_OBJECT(Stage)
 public:
  /// Called once after the parameters have been read; loads what the stage needs. Throws ConfigError or
  /// InputError.
  virtual void prepare() {}
};

}  // namespace roomgraph
