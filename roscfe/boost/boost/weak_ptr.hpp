// Weak pointers are the standard library's.
#ifndef BOOST_WEAK_PTR_HPP_INCLUDED
#define BOOST_WEAK_PTR_HPP_INCLUDED

#include "boost/shared_ptr.hpp"

namespace boost
{

using std::weak_ptr;

} // namespace boost

#endif
