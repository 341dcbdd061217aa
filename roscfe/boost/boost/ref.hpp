// References as values, for bind.
#ifndef BOOST_REF_HPP_INCLUDED
#define BOOST_REF_HPP_INCLUDED

#include <functional>

namespace boost
{

using std::cref;
using std::ref;
using std::reference_wrapper;

} // namespace boost

#endif
