// Boost's newer place for it.
#ifndef BOOST_BIND_MEM_FN_HPP_INCLUDED
#define BOOST_BIND_MEM_FN_HPP_INCLUDED

#include "boost/mem_fn.hpp"

#endif
