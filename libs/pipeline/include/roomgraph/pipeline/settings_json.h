// SPDX-License-Identifier: BSD-3-Clause
// Settings of sensors that a run begins anew with, as JSON: in summary.json and in the checkpoint of a run.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "roomgraph/pipeline/clock_settings.h"
#include "roomgraph/pipeline/mount_settings.h"

namespace roomgraph {

nlohmann::ordered_json jsonOf(const ClockSetting& clock);
nlohmann::ordered_json jsonOf(const MountSetting& mount);
/// The same again, to the last bit. Throw nlohmann's exceptions for what is missing or of another type, InputError for a sensor that there
/// is not.
ClockSetting clockFrom(const nlohmann::ordered_json& json);
MountSetting mountFrom(const nlohmann::ordered_json& json);

}  // namespace roomgraph
