#ifndef BOOST_THREAD_HPP_INCLUDED
#define BOOST_THREAD_HPP_INCLUDED
#include "boost/thread/thread.hpp"
#endif
