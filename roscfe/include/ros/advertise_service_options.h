#ifndef ROS_ADVERTISE_SERVICE_OPTIONS_H
#define ROS_ADVERTISE_SERVICE_OPTIONS_H
#include "ros/service_server.h"
#endif
