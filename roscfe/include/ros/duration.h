// Spans of time: seconds and nanoseconds, both signed; the nanoseconds are 0 to 999,999,999, also of a negative span.
#ifndef ROSCFE_ROS_DURATION_H
#define ROSCFE_ROS_DURATION_H

#include <stdint.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
#include <stdexcept>

#include "roscfe/parts.h"
#include "roscfe/refuse.h"

namespace roscfe
{
namespace detail
{

constexpr int64_t kNanoseconds = 1000000000; // in a second

// What times and spans have in common: their order, and the number of seconds.
template <class T>
class Moment
{
  public:
    constexpr bool operator==(const T &other) const { return own().sec == other.sec && own().nsec == other.nsec; }
    constexpr bool operator!=(const T &other) const { return !(*this == other); }
    constexpr bool operator<(const T &other) const
    {
        return own().sec != other.sec ? own().sec < other.sec : own().nsec < other.nsec;
    }
    constexpr bool operator>(const T &other) const { return other < own(); }
    constexpr bool operator<=(const T &other) const { return !(*this > other); }
    constexpr bool operator>=(const T &other) const { return !(*this < other); }

    double toSec() const { return static_cast<double>(own().sec) + 1e-9 * static_cast<double>(own().nsec); }

  private:
    constexpr const T &own() const { return *static_cast<const T *>(this); }
};

// Print a sign, seconds, a point and nine digits. As in ROS the stream's width is for what comes first, and is there
// again afterwards.
template <class Stream, class Seconds>
Stream &print_seconds(Stream &os, const char *sign, Seconds sec, uint32_t nsec)
{
    const auto width = os.width();
    if (sign)
        os << sign;
    os << sec << '.';
    const char fill = os.fill('0');
    os << std::setw(9) << nsec;
    os.fill(fill);
    os.width(width);
    return os;
}

} // namespace detail
} // namespace roscfe

namespace ros
{

// Bring nanoseconds into 0 to 999,999,999. What does not fit into 32 bits of seconds is a std::runtime_error.
constexpr void normalizeSecNSecSigned(int64_t &sec, int64_t &nsec)
{
    int64_t whole = sec + nsec / roscfe::detail::kNanoseconds;
    int64_t rest = nsec % roscfe::detail::kNanoseconds;
    if (rest < 0)
    {
        rest += roscfe::detail::kNanoseconds;
        --whole;
    }
    if (whole < std::numeric_limits<int32_t>::min() || whole > std::numeric_limits<int32_t>::max())
        ROSCFE_THROW(std::runtime_error("Duration is out of dual 32-bit range"));
    sec = whole;
    nsec = rest;
}

constexpr void normalizeSecNSecSigned(int32_t &sec, int32_t &nsec)
{
    int64_t wide_sec = sec, wide_nsec = nsec;
    normalizeSecNSecSigned(wide_sec, wide_nsec);
    sec = static_cast<int32_t>(wide_sec);
    nsec = static_cast<int32_t>(wide_nsec);
}

template <class T>
class DurationBase : public roscfe::detail::Moment<T>
{
  public:
    int32_t sec, nsec;

    constexpr DurationBase() : sec(0), nsec(0) {}
    constexpr DurationBase(int32_t seconds, int32_t nanoseconds) : sec(seconds), nsec(nanoseconds)
    {
        normalizeSecNSecSigned(sec, nsec);
    }
    explicit DurationBase(double seconds) : sec(0), nsec(0) { fromSec(seconds); }

    T operator+(const T &other) const { return from(toNSec() + other.toNSec()); }
    T operator-(const T &other) const { return from(toNSec() - other.toNSec()); }
    T operator-() const { return from(-toNSec()); }
    T operator*(double scale) const { return T(this->toSec() * scale); }

    T &operator+=(const T &other) { return fromNSec(toNSec() + other.toNSec()); }
    T &operator-=(const T &other) { return *this += -other; }
    T &operator*=(double scale) { return fromSec(this->toSec() * scale); }

    constexpr int64_t toNSec() const
    {
        return static_cast<int64_t>(sec) * roscfe::detail::kNanoseconds + static_cast<int64_t>(nsec);
    }

    // Set to a number of seconds, rounded to nanoseconds. Outside of 32 bits of seconds: std::runtime_error.
    T &fromSec(double seconds)
    {
        const double whole = std::floor(seconds);
        if (!(whole >= -2147483648.0 && whole <= 2147483647.0)) // also what is no number
            ROSCFE_THROW(std::runtime_error("Duration is out of dual 32-bit range"));
        sec = static_cast<int32_t>(whole);
        nsec = static_cast<int32_t>(std::round((seconds - sec) * 1e9));
        const int32_t carry = nsec / 1000000000;
        sec = static_cast<int32_t>(static_cast<uint32_t>(sec) + static_cast<uint32_t>(carry));
        nsec %= 1000000000;
        return *static_cast<T *>(this);
    }

    // Set to a number of nanoseconds. Outside of 32 bits of seconds: std::runtime_error.
    T &fromNSec(int64_t nanoseconds)
    {
        int64_t wide_sec = nanoseconds / roscfe::detail::kNanoseconds;
        int64_t wide_nsec = nanoseconds % roscfe::detail::kNanoseconds;
        normalizeSecNSecSigned(wide_sec, wide_nsec);
        sec = static_cast<int32_t>(wide_sec);
        nsec = static_cast<int32_t>(wide_nsec);
        return *static_cast<T *>(this);
    }

    constexpr bool isZero() const { return sec == 0 && nsec == 0; }

  private:
    static T from(int64_t nanoseconds)
    {
        T made;
        return made.fromNSec(nanoseconds);
    }
};

class Rate;
class WallRate;

// A span of the mission's time.
class Duration : public DurationBase<Duration>
{
  public:
    constexpr Duration() = default;
    constexpr Duration(int32_t seconds, int32_t nanoseconds) : DurationBase<Duration>(seconds, nanoseconds) {}
    explicit Duration(double seconds) : DurationBase<Duration>(seconds) {}
    explicit Duration(const Rate &rate);

    bool sleep() const
    {
        roscfe::parts::need(roscfe::parts::exact_waits); // of short ones
        return sleep_now();
    }
    bool sleep_now() const;
};

// A span of the host's time, which on cFE is the mission's too.
class WallDuration : public DurationBase<WallDuration>
{
  public:
    constexpr WallDuration() = default;
    constexpr WallDuration(int32_t seconds, int32_t nanoseconds) : DurationBase<WallDuration>(seconds, nanoseconds) {}
    explicit WallDuration(double seconds) : DurationBase<WallDuration>(seconds) {}
    explicit WallDuration(const Rate &rate);
    explicit WallDuration(const WallRate &rate);

    bool sleep() const
    {
        roscfe::parts::need(roscfe::parts::exact_waits); // of short ones
        return sleep_now();
    }
    bool sleep_now() const;
};

// A negative span is printed as a person writes it: -0.5, which is kept as -1 second and 500,000,000 nanoseconds.
template <class Stream, class T>
Stream &print_on(Stream &os, const DurationBase<T> &duration)
{
    using roscfe::detail::print_seconds;
    if (duration.sec >= 0 || duration.nsec == 0)
        return print_seconds(os, nullptr, duration.sec, static_cast<uint32_t>(duration.nsec));
    const char *sign = duration.sec == -1 ? "-" : "";
    return print_seconds(os, sign, duration.sec + 1, static_cast<uint32_t>(1000000000 - duration.nsec));
}

template <class T>
std::ostream &operator<<(std::ostream &os, const DurationBase<T> &duration)
{
    return print_on(os, duration);
}

inline constexpr Duration DURATION_MAX(std::numeric_limits<int32_t>::max(), 999999999);
inline constexpr Duration DURATION_MIN(std::numeric_limits<int32_t>::min(), 0);

} // namespace ros

#endif
