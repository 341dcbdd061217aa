// In ROS the samples of one frame. Here they are in the buffer, which has room for all frames together.
#ifndef TF2_TIME_CACHE_H
#define TF2_TIME_CACHE_H

#include "tf2/buffer_core.h"
#include "tf2/transform_storage.h"

#endif
