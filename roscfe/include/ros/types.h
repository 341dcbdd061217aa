// Integers of a known size.
#ifndef ROSCFE_ROS_TYPES_H
#define ROSCFE_ROS_TYPES_H

#include <stdint.h>

#endif
