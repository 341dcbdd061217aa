// How a lock begins: without its mutex, with one that is locked already, or with one that is free.
#ifndef BOOST_THREAD_LOCK_OPTIONS_HPP
#define BOOST_THREAD_LOCK_OPTIONS_HPP

namespace boost
{

struct defer_lock_t
{
};
struct try_to_lock_t
{
};
struct adopt_lock_t
{
};
inline constexpr defer_lock_t  defer_lock  = {};
inline constexpr try_to_lock_t try_to_lock = {};
inline constexpr adopt_lock_t  adopt_lock  = {};

} // namespace boost

#endif
