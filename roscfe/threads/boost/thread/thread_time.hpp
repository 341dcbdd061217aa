// Times and durations of waits: those of the standard library, and those of the computer's Boost where it is used.
#ifndef BOOST_THREAD_THREAD_TIME_HPP
#define BOOST_THREAD_THREAD_TIME_HPP

#include <chrono>
#include <cstdint>
#include <type_traits>
#include <utility>

#if !__has_include(<roscfe_small_boost.h>) && __has_include(<boost/date_time/posix_time/posix_time_types.hpp>)
// As names of macros: cfepy takes the computer's Boost for a node whose headers name what the small one lacks.
#define ROSCFE_CHRONO <boost/chrono/system_clocks.hpp>
#define ROSCFE_CLOCK <boost/date_time/microsec_time_clock.hpp>
#define ROSCFE_TIMES <boost/date_time/posix_time/posix_time_types.hpp>
#include ROSCFE_CHRONO
#include ROSCFE_CLOCK
#include ROSCFE_TIMES

namespace boost
{

typedef posix_time::ptime system_time;

inline system_time get_system_time()
{
    return posix_time::microsec_clock::universal_time();
}

} // namespace boost
#endif

namespace boost
{
namespace roscfe_time
{

constexpr std::int64_t kNs = 1000000000;

template <class T, class = void>
struct is_posix_duration : std::false_type
{
};
template <class T>
struct is_posix_duration<T, std::void_t<decltype(std::declval<const T &>().total_microseconds())>> : std::true_type
{
};

template <class T, class = void>
struct has_clock : std::false_type
{
};
template <class T>
struct has_clock<T, std::void_t<typename T::clock>> : std::true_type
{
};

// A duration in nanoseconds.
template <class Duration>
std::int64_t in_ns(const Duration &duration)
{
    if constexpr (is_posix_duration<Duration>::value)
    {
        return static_cast<std::int64_t>(duration.total_microseconds()) * 1000;
    }
    else
    {
        using Period = typename Duration::period;
        return static_cast<std::int64_t>(duration.count() * (static_cast<typename Duration::rep>(kNs / Period::den) *
                                                            static_cast<typename Duration::rep>(Period::num)));
    }
}

// How long it is from now on: a duration, or the time until a moment.
template <class Time>
std::int64_t rest(const Time &time)
{
    if constexpr (has_clock<Time>::value)
    {
        return in_ns(time - Time::clock::now());
    }
#if !__has_include(<roscfe_small_boost.h>) && __has_include(<boost/date_time/posix_time/posix_time_types.hpp>)
    else if constexpr (std::is_same<Time, posix_time::ptime>::value)
    {
        return in_ns(time - get_system_time());
    }
#endif
    else
    {
        return in_ns(time);
    }
}

} // namespace roscfe_time
} // namespace boost

#endif
