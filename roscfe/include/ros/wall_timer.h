#ifndef ROS_WALL_TIMER_H
#define ROS_WALL_TIMER_H
#include "ros/timer.h"
#endif
