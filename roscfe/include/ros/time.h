// Points in time: seconds and nanoseconds since an epoch, both unsigned. What time it is, the core knows.
#ifndef ROSCFE_ROS_TIME_H
#define ROSCFE_ROS_TIME_H

#include <stdint.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <stdexcept>

#include <boost/utility/enable_if.hpp> // as in roscpp, where all headers bring it along

#include "ros/duration.h"
#include "ros/exception.h"
#include "roscfe/refuse.h"

namespace ros
{

class TimeNotInitializedException : public Exception
{
  public:
    TimeNotInitializedException() : Exception("the time is not known before a NodeHandle or ros::start()") {}
};

// Bring nanoseconds into 0 to 999,999,999. What does not fit into 32 bits of seconds is a std::runtime_error.
constexpr void normalizeSecNSec(uint64_t &sec, uint64_t &nsec)
{
    const uint64_t whole = sec + nsec / 1000000000u;
    if (whole > std::numeric_limits<uint32_t>::max())
        ROSCFE_THROW(std::runtime_error("Time is out of dual 32-bit range"));
    sec = whole;
    nsec %= 1000000000u;
}

constexpr void normalizeSecNSec(uint32_t &sec, uint32_t &nsec)
{
    uint64_t wide_sec = sec, wide_nsec = nsec;
    normalizeSecNSec(wide_sec, wide_nsec);
    sec = static_cast<uint32_t>(wide_sec);
    nsec = static_cast<uint32_t>(wide_nsec);
}

// As above, of a sum that may be negative: then it is a std::runtime_error.
constexpr void normalizeSecNSecUnsigned(int64_t &sec, int64_t &nsec)
{
    int64_t whole = sec + nsec / roscfe::detail::kNanoseconds;
    int64_t rest = nsec % roscfe::detail::kNanoseconds;
    if (rest < 0)
    {
        rest += roscfe::detail::kNanoseconds;
        --whole;
    }
    if (whole < 0 || whole > std::numeric_limits<uint32_t>::max())
        ROSCFE_THROW(std::runtime_error("Time is out of dual 32-bit range"));
    sec = whole;
    nsec = rest;
}

template <class T, class D>
class TimeBase : public roscfe::detail::Moment<T>
{
  public:
    uint32_t sec, nsec;

    constexpr TimeBase() : sec(0), nsec(0) {}
    constexpr TimeBase(uint32_t seconds, uint32_t nanoseconds) : sec(seconds), nsec(nanoseconds)
    {
        normalizeSecNSec(sec, nsec);
    }
    explicit TimeBase(double seconds) : sec(0), nsec(0) { fromSec(seconds); }

    D operator-(const T &other) const
    {
        D made;
        return made.fromNSec(static_cast<int64_t>(toNSec() - other.toNSec()));
    }

    T operator+(const D &span) const
    {
        int64_t wide_sec = static_cast<int64_t>(sec) + span.sec;
        int64_t wide_nsec = static_cast<int64_t>(nsec) + span.nsec;
        normalizeSecNSecUnsigned(wide_sec, wide_nsec);
        return T(static_cast<uint32_t>(wide_sec), static_cast<uint32_t>(wide_nsec));
    }

    T operator-(const D &span) const { return *this + (-span); }

    T &operator+=(const D &span) { return assign(*this + span); }
    T &operator-=(const D &span) { return assign(*this + (-span)); }

    constexpr uint64_t toNSec() const { return static_cast<uint64_t>(sec) * 1000000000u + nsec; }

    // Set to a number of seconds, rounded to nanoseconds. Outside of 32 bits of seconds: std::runtime_error.
    T &fromSec(double seconds)
    {
        const double whole = std::floor(seconds);
        if (!(whole >= 0.0 && whole <= 4294967295.0)) // also what is no number
            ROSCFE_THROW(std::runtime_error("Time is out of dual 32-bit range"));
        sec = static_cast<uint32_t>(whole);
        nsec = static_cast<uint32_t>(std::round((seconds - sec) * 1e9));
        sec += nsec / 1000000000u;
        nsec %= 1000000000u;
        return *static_cast<T *>(this);
    }

    // Set to a number of nanoseconds. Outside of 32 bits of seconds: std::runtime_error.
    T &fromNSec(uint64_t nanoseconds)
    {
        uint64_t wide_sec = 0, wide_nsec = nanoseconds;
        normalizeSecNSec(wide_sec, wide_nsec);
        sec = static_cast<uint32_t>(wide_sec);
        nsec = static_cast<uint32_t>(wide_nsec);
        return *static_cast<T *>(this);
    }

    constexpr bool isZero() const { return sec == 0 && nsec == 0; }
    constexpr bool is_zero() const { return isZero(); }

  private:
    T &assign(const T &other)
    {
        sec = other.sec;
        nsec = other.nsec;
        return *static_cast<T *>(this);
    }
};

template <class Stream, class T, class D>
Stream &print_on(Stream &os, const TimeBase<T, D> &time)
{
    return roscfe::detail::print_seconds(os, nullptr, time.sec, time.nsec);
}

template <class T, class D>
std::ostream &operator<<(std::ostream &os, const TimeBase<T, D> &time)
{
    return print_on(os, time);
}

// The mission's time.
class Time : public TimeBase<Time, Duration>
{
  public:
    constexpr Time() = default;
    constexpr Time(uint32_t seconds, uint32_t nanoseconds) : TimeBase<Time, Duration>(seconds, nanoseconds) {}
    explicit Time(double seconds) : TimeBase<Time, Duration>(seconds) {}

    static Time now();
    static bool sleepUntil(const Time &end);

    static void init();
    static void shutdown();
    static void setNow(const Time &now);
    static bool useSystemTime();
    static bool isSimTime();
    static bool isSystemTime();

    static bool isValid();
    static bool waitForValid();
    static bool waitForValid(const WallDuration &timeout);
};

inline constexpr Time TIME_MAX(std::numeric_limits<uint32_t>::max(), 999999999);
inline constexpr Time TIME_MIN(0, 1); // zero stands for no time

// The host's time in ROS; on cFE it is the mission's too.
class WallTime : public TimeBase<WallTime, WallDuration>
{
  public:
    constexpr WallTime() = default;
    constexpr WallTime(uint32_t seconds, uint32_t nanoseconds) : TimeBase<WallTime, WallDuration>(seconds, nanoseconds)
    {
    }
    explicit WallTime(double seconds) : TimeBase<WallTime, WallDuration>(seconds) {}

    static WallTime now();
    static bool     sleepUntil(const WallTime &end);
    static bool     isSystemTime() { return true; }
};

// A time that nobody sets: on cFE the time since the start of the processor.
class SteadyTime : public TimeBase<SteadyTime, WallDuration>
{
  public:
    constexpr SteadyTime() = default;
    constexpr SteadyTime(uint32_t seconds, uint32_t nanoseconds)
        : TimeBase<SteadyTime, WallDuration>(seconds, nanoseconds)
    {
    }
    explicit SteadyTime(double seconds) : TimeBase<SteadyTime, WallDuration>(seconds) {}

    static SteadyTime now();
    static bool       sleepUntil(const SteadyTime &end);
    static bool       isSystemTime() { return true; }
};

} // namespace ros

#endif
