#ifndef ROS_STEADY_TIMER_OPTIONS_H
#define ROS_STEADY_TIMER_OPTIONS_H
#include "ros/timer.h"
#endif
