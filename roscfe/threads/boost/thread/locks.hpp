// All locks.
#ifndef BOOST_THREAD_LOCKS_HPP
#define BOOST_THREAD_LOCKS_HPP

#include "boost/thread/lock_guard.hpp"
#include "boost/thread/lock_options.hpp"
#include "boost/thread/lock_types.hpp"

#endif
