// Boost's newer place for it.
#ifndef BOOST_BIND_BIND_HPP_INCLUDED
#define BOOST_BIND_BIND_HPP_INCLUDED

#include "boost/bind.hpp"

#endif
