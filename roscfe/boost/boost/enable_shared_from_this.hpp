// enable_shared_from_this is the standard library's.
#ifndef BOOST_ENABLE_SHARED_FROM_THIS_HPP_INCLUDED
#define BOOST_ENABLE_SHARED_FROM_THIS_HPP_INCLUDED

#include "boost/shared_ptr.hpp"

namespace boost
{

using std::enable_shared_from_this;

} // namespace boost

#endif
