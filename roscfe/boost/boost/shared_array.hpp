// A shared array is the standard library's shared pointer to an array.
#ifndef BOOST_SHARED_ARRAY_HPP_INCLUDED
#define BOOST_SHARED_ARRAY_HPP_INCLUDED

#include "boost/shared_ptr.hpp"

namespace boost
{

template <class T>
using shared_array = std::shared_ptr<T[]>;

} // namespace boost

#endif
