// bind is the standard library's. As with Boost's own header, its placeholders _1, _2... are names of the global scope.
#ifndef BOOST_BIND_HPP_INCLUDED
#define BOOST_BIND_HPP_INCLUDED

#include <functional>

#include "boost/is_placeholder.hpp"
#include "boost/mem_fn.hpp"
#include "boost/ref.hpp"

namespace boost
{

using std::bind;

namespace placeholders = std::placeholders;

} // namespace boost

using namespace std::placeholders;

#endif
