// make_shared and allocate_shared are the standard library's.
#ifndef BOOST_MAKE_SHARED_HPP_INCLUDED
#define BOOST_MAKE_SHARED_HPP_INCLUDED

#include "boost/shared_ptr.hpp"

namespace boost
{

using std::allocate_shared;
using std::make_shared;

} // namespace boost

#endif
