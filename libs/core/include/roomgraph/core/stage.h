// SPDX-License-Identifier: BSD-3-Clause
// Stage: common base of the exchangeable pipeline steps chosen by class name.
#pragma once

#include <mrpt/rtti/CObject.h>

#include "roomgraph/core/parameters.h"

namespace roomgraph {

class ResultStore;

/// Base of every exchangeable step of the pipeline. An interface derives from it with one verb over plain
/// structs; implementations are registered with MRPT's class factory and chosen by class name in config.ini.
class Stage : public mrpt::rtti::CObject, public Configurable {
  DEFINE_VIRTUAL_MRPT_OBJECT(Stage)
 public:
  /// Called once after the parameters have been read; loads what the stage needs. Throws ConfigError or
  /// InputError.
  virtual void prepare() {}
  /// What takes long and whose result is small may be kept there, so that a run that was killed need not
  /// compute it again (recalled() in core/result_store.h). Called after prepare(), if at all; the store
  /// outlives the stage's work.
  virtual void setResultStore(ResultStore& store) { (void)store; }
};

}  // namespace roomgraph
