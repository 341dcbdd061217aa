// Boost's newer place for it.
#ifndef BOOST_CORE_REF_HPP_INCLUDED
#define BOOST_CORE_REF_HPP_INCLUDED

#include "boost/ref.hpp"

#endif
