#ifndef ROS_WALL_TIMER_OPTIONS_H
#define ROS_WALL_TIMER_OPTIONS_H
#include "ros/timer.h"
#endif
