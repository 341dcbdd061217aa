// Threads. A node for the host has them: each is a task of cFE, and they take turns. In the other profiles there are only
// the mutexes, and the name of the one task.
#ifndef BOOST_THREAD_THREAD_HPP
#define BOOST_THREAD_THREAD_HPP

#include "boost/thread/locks.hpp"
#include "boost/thread/mutex.hpp"
#include "boost/thread/recursive_mutex.hpp"

#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)

#include <ostream>

namespace boost
{
namespace this_thread
{

// Of the one task; all are equal.
struct roscfe_id
{
    bool operator==(roscfe_id) const { return true; }
    bool operator!=(roscfe_id) const { return false; }
    bool operator<(roscfe_id) const { return false; }
};

inline roscfe_id get_id()
{
    return roscfe_id();
}

inline std::ostream &operator<<(std::ostream &stream, roscfe_id)
{
    return stream << 1;
}

} // namespace this_thread
} // namespace boost

#else

#include "boost/thread/thread_group.hpp"
#include "boost/thread/thread_only.hpp"

#endif

#endif
