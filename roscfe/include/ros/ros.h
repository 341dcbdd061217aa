// All of roscpp that most nodes include.
#ifndef ROSCPP_ROS_H
#define ROSCPP_ROS_H

#include "ros/time.h"

#include "ros/rate.h"

#include "ros/console.h"

#include "ros/assert.h"

#include "ros/common.h"
#include "ros/types.h"

#include "ros/init.h"
#include "ros/master.h"
#include "ros/message_event.h"
#include "ros/names.h"
#include "ros/node_handle.h"
#include "ros/param.h"
#include "ros/publisher.h"
#include "ros/service.h"
#include "ros/service_client.h"
#include "ros/service_server.h"
#include "ros/single_subscriber_publisher.h"
#include "ros/spinner.h"
#include "ros/subscriber.h"
#include "ros/this_node.h"
#include "ros/timer.h"
#include "ros/topic.h"

#endif
