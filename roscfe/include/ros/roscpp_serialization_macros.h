// A word that headers with their own serializers use.
#ifndef ROSCFE_ROS_ROSCPP_SERIALIZATION_MACROS_H
#define ROSCFE_ROS_ROSCPP_SERIALIZATION_MACROS_H

#include "ros/macros.h"

#define ROSCPP_SERIALIZATION_DECL

#endif
