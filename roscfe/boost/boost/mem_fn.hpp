// A member function as a callable.
#ifndef BOOST_MEM_FN_HPP_INCLUDED
#define BOOST_MEM_FN_HPP_INCLUDED

#include <functional>

namespace boost
{

using std::mem_fn;

} // namespace boost

#endif
