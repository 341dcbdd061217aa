// In ROS the samples of one frame. Here they are in the buffer, which has room for all frames together.
#ifndef TF_TIME_CACHE_H
#define TF_TIME_CACHE_H

#include "tf/transform_datatypes.h"

#endif
