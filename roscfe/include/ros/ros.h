// All of roscpp that most nodes include.
#ifndef ROSCPP_ROS_H
#define ROSCPP_ROS_H

// roscpp brings these along, and nodes rely on it: isnan without std::, boost::lexical_cast, usleep, INT_MAX.
#include <boost/lexical_cast.hpp>
#include <boost/noncopyable.hpp>

#include <cassert>
#include <cfloat>
#include <climits>
#include <complex>
#include <mutex>
#if defined(_GLIBCXX_HAS_GTHREADS) || defined(_LIBCPP_VERSION) || !defined(ROSCFE_PROFILE_HOST)
#include <boost/thread/mutex.hpp>
#endif

#include <math.h>
#if __has_include(<sys/time.h>)
#include <sys/time.h>
#endif
#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

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
