#ifndef ROS_TIMER_OPTIONS_H
#define ROS_TIMER_OPTIONS_H
#include "ros/timer.h"
#endif
