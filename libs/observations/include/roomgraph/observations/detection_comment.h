// SPDX-License-Identifier: BSD-3-Clause
// Detections stored as MRPT comment records with JSON text.
#pragma once

#include <mrpt/obs/CObservationComment.h>

#include "roomgraph/core/outcome.h"
#include "roomgraph/observations/CObservationDetections.h"

namespace roomgraph {

/// Detections as a record that every program of MRPT can read, cut and filter without our library: a comment
/// with the image's time stamp whose text is one JSON object (docs/formats.md). Nothing is lost: numbers come
/// back bit by bit.
mrpt::obs::CObservationComment toComment(const CObservationDetections& detections);

/// Whether a comment says that it holds detections; others are none of our business.
bool holdsDetections(const mrpt::obs::CObservationComment& comment);

/// The detections of such a comment, with the comment's stamp and label; or what is wrong with its text.
Outcome<CObservationDetections::Ptr> fromComment(const mrpt::obs::CObservationComment& comment);

/// What a record of a rawlog stands for: the detections of a comment that holds them, itself for all others;
/// or why the comment cannot be read.
Outcome<mrpt::obs::CObservation::Ptr> unpacked(const mrpt::obs::CObservation::Ptr& observation);

}  // namespace roomgraph
