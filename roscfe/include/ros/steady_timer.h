#ifndef ROS_STEADY_TIMER_H
#define ROS_STEADY_TIMER_H
#include "ros/timer.h"
#endif
