// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the RgbdOdometry interface.
#include "roomgraph/tracking/rgbd_odometry.h"

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(RgbdOdometry, Stage, roomgraph)
