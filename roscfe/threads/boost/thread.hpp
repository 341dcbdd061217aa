// Threads, locks and all that belongs to them, as Boost's header of this name has.
#ifndef BOOST_THREAD_HPP_INCLUDED
#define BOOST_THREAD_HPP_INCLUDED

#include "boost/thread/thread.hpp"

#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)
#include "boost/thread/barrier.hpp"
#include "boost/thread/condition_variable.hpp"
#include "boost/thread/once.hpp"
#include "boost/thread/shared_mutex.hpp"
#include "boost/thread/tss.hpp"
#endif

#endif
