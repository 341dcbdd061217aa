// Prints what ros::Time and ros::Duration make of sums, bounds and formats. It compiles against roscpp's headers as well:
// times.txt is what it prints there.
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include <ros/duration.h>
#include <ros/time.h>

using namespace ros;

template <class Function>
void print(const char *expression, Function function)
{
    std::ostringstream out;
    try
    {
        function(out);
    }
    catch (const std::runtime_error &error)
    {
        out << "throws " << error.what();
    }
    std::printf("%s: %s\n", expression, out.str().c_str());
}

#define PRINT(expression) print(#expression, [&](std::ostream &out) { out << expression; })

static void durations()
{
    PRINT(Duration(-0.5));
    PRINT(Duration(-1, 500000000));
    PRINT(Duration(-1, 0));
    PRINT(Duration(-0.000000001));
    PRINT(Duration(1, -1));
    PRINT(Duration(-3.25));
    PRINT(DURATION_MIN);
    PRINT(DURATION_MAX);
    PRINT(WallDuration(-2.5));
    PRINT(Duration(0.9999999999));
    PRINT(Duration(2147483647.9999999999));
    PRINT(Duration(2147483648.0));
    PRINT(Duration(-2147483649.0));
    PRINT(Duration(-2147483648.0));
    PRINT(Duration(NAN));
    PRINT(DURATION_MAX + Duration(0, 1));
    PRINT(-DURATION_MIN);
    PRINT(Duration(1.5) * -2.3);
    PRINT(Duration(2147483647, 0) * 2);
    PRINT(Duration(2147483647, 1999999999));
    PRINT(Duration(-2147483647 - 1, -1));
    PRINT(Duration(1, 2).toSec());
    PRINT(Duration(-1, 2).toNSec());
    PRINT((Duration(1, 0) < Duration(1, 1)) << (Duration(-1, 5) > Duration(-2, 9)) << (Duration(1, 0) <= Duration(1, 0)));
    Duration made;
    PRINT(made.fromNSec(-1));
    PRINT(made.fromNSec(-9223372036854775807LL - 1));
    PRINT((made += Duration(2, 5)));
    PRINT((made -= Duration(7, 1)));
    PRINT((made *= 0.5));
}

static void times()
{
    PRINT(Time(1, 2));
    PRINT(Time(1, 1999999999));
    PRINT(Time(4294967295u, 999999999));
    PRINT(Time(4294967295u, 1000000000));
    PRINT(TIME_MIN);
    PRINT(TIME_MAX);
    PRINT(Time(-1.0));
    PRINT(Time(4294967296.0));
    PRINT(Time(4294967295.9999999));
    PRINT(Time(0.9999999999));
    PRINT(Time(NAN));
    PRINT(Time(INFINITY));
    PRINT(Time(5, 0) - Time(7, 500000000));
    PRINT(Time(4000000000u, 0) - Time(0, 0));
    PRINT(Time(0, 0) - Time(4000000000u, 0));
    PRINT(Time(1, 0) - Duration(2, 0));
    PRINT(Time(1, 0) + Duration(-1, 0));
    PRINT(Time(4294967295u, 0) + Duration(1, 0));
    PRINT(TIME_MAX + Duration(0, 1));
    PRINT(WallTime(3, 0) - WallTime(1, 1));
    PRINT(SteadyTime(3, 0) + WallDuration(0.25));
    PRINT((Time(1, 0) < Time(1, 1)) << (Time(2, 0) >= Time(1, 9)) << (Time(1, 0) != Time(1, 0)) << Time().isZero());
    Time made(1, 2);
    PRINT(made.fromNSec(18446744073709551615ull));
    PRINT(made.fromNSec(5000000001ull));
    PRINT((made += Duration(-2, 5)));
    PRINT((made -= Duration(2.5)));
    PRINT(made.toNSec());
    PRINT(made.fromSec(1234567.891));
    PRINT(std::fixed << made.toSec());
}

static void formats()
{
    PRINT(std::setw(20) << std::setfill('*') << Time(1, 5));
    PRINT(std::hex << Time(31, 31));
    PRINT(std::setw(14) << Time(1, 5) << "|");
    PRINT(std::setw(14) << Duration(-1, 5) << "|");
    PRINT(std::setw(14) << Duration(-3, 5) << "|");
    PRINT(std::setw(12) << Duration(3, 4) << "|" << std::setw(5) << 1);
}

static void normal_forms()
{
    {
        uint32_t sec = 4294967295u, nsec = 4000000000u;
        PRINT((normalizeSecNSec(sec, nsec), sec) << " " << nsec);
    }
    {
        uint64_t sec = 4294967296ull, nsec = 0;
        PRINT((normalizeSecNSec(sec, nsec), sec) << " " << nsec);
    }
    const int64_t sums[][2] = {{1, -1}, {0, -1}, {4294967296ll, -1}, {3000000000ll, 0}, {1, -1000000001}};
    for (const auto &sum : sums)
    {
        int64_t sec = sum[0], nsec = sum[1];
        PRINT((normalizeSecNSecUnsigned(sec, nsec), sec) << " " << nsec);
        sec = sum[0], nsec = sum[1];
        PRINT((normalizeSecNSecSigned(sec, nsec), sec) << " " << nsec);
    }
}

int main()
{
    durations();
    times();
    formats();
    normal_forms();
}
