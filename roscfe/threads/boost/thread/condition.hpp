// The old name of a condition.
#ifndef BOOST_THREAD_CONDITION_HPP
#define BOOST_THREAD_CONDITION_HPP

#include "boost/thread/condition_variable.hpp"

namespace boost
{
typedef condition_variable_any condition;
} // namespace boost

#endif
