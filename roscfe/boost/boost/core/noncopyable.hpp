// Boost's newer place for it.
#ifndef BOOST_CORE_NONCOPYABLE_HPP_INCLUDED
#define BOOST_CORE_NONCOPYABLE_HPP_INCLUDED

#include "boost/noncopyable.hpp"

#endif
