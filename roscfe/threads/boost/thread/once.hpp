// What only the first thread does that comes to it.
#ifndef BOOST_THREAD_ONCE_HPP
#define BOOST_THREAD_ONCE_HPP

#include <mutex>
#include <utility>

namespace boost
{

struct once_flag
{
    std::once_flag flag;
};

template <class F, class... Arguments>
void call_once(once_flag &once, F &&function, Arguments &&... arguments)
{
    std::call_once(once.flag, std::forward<F>(function), std::forward<Arguments>(arguments)...);
}

// The old order.
inline void call_once(void (*function)(), once_flag &once)
{
    std::call_once(once.flag, function);
}

} // namespace boost

#define BOOST_ONCE_INIT {}

#endif
