// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/tracking/rgbd_odometry.h"

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(RgbdOdometry, Stage, roomgraph)
