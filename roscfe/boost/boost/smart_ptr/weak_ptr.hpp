// Boost's newer place for it.
#ifndef BOOST_SMART_PTR_WEAK_PTR_HPP_INCLUDED
#define BOOST_SMART_PTR_WEAK_PTR_HPP_INCLUDED

#include "boost/weak_ptr.hpp"

#endif
