// Headers that ros/node_handle.h and ros/ros.h bring along in roscpp, and nodes rely on: logging, isnan without std::,
// boost::lexical_cast, usleep, INT_MAX.
#ifndef ROSCFE_BROUGHT_ALONG_H
#define ROSCFE_BROUGHT_ALONG_H

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

#include "ros/assert.h"
#include "ros/console.h"

#endif
