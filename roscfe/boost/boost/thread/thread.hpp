// What is there of Boost's threads in nodes that have none: mutexes, and the name of the one task. Nodes for the host get
// the computer's Boost in its place, which has threads.
#ifndef BOOST_THREAD_THREAD_HPP
#define BOOST_THREAD_THREAD_HPP

#include <ostream>

#include "boost/thread/locks.hpp"
#include "boost/thread/mutex.hpp"
#include "boost/thread/recursive_mutex.hpp"

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

#endif
