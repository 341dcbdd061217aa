#ifndef BOOST_UTILITY_ENABLE_IF_HPP_INCLUDED
#define BOOST_UTILITY_ENABLE_IF_HPP_INCLUDED

#include <boost/core/enable_if.hpp>

#endif
