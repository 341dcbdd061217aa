// LogStream beside std::ostringstream: the same statements, and the same characters.
#include <bitset>
#include <complex>
#include <cstdio>
#include <limits>
#include <random>
#include <sstream>

#include "ros/console.h"
#include "roscfe/fixed.h"

namespace
{

int g_cases = 0, g_different = 0;

struct Own
{
    int number;
};
std::ostream &operator<<(std::ostream &to, const Own &own)
{
    return to << "own " << own.number;
}
enum Colour
{
    kRed = 3
};

void compare(const std::string &found, const std::string &wanted)
{
    ++g_cases;
    if (found != wanted)
    {
        ++g_different;
        std::printf("[%s] and not [%s]\n", found.c_str(), wanted.c_str());
    }
}

std::string nested()
{
    roscfe::LogStream inner;
    inner << "inner " << 7;
    return inner.text();
}

} // namespace

#define SAME(args)                                                                                                     \
    do                                                                                                                 \
    {                                                                                                                  \
        roscfe::LogStream  ours;                                                                                       \
        std::ostringstream theirs;                                                                                     \
        ours << args;                                                                                                  \
        theirs << args;                                                                                                \
        compare(ours.text(), theirs.str());                                                                            \
    } while (0)

int main()
{
    const char    array[8] = "array";
    int           number   = -42;
    const Own     own      = {4};
    std::mt19937_64 random(7);
    const roscfe::FixedString<16> fixed = "fixed";
    SAME("a" << 'b' << std::string("c") << array << std::string_view("view") << static_cast<unsigned char>('u') << fixed);
    SAME(number << ' ' << 42U << ' ' << 42L << ' ' << -42LL << ' ' << static_cast<short>(-1) << true << false);
    SAME(std::hex << number << ' ' << 255 << std::showbase << ' ' << 255 << std::uppercase << ' ' << 255 << std::oct << ' ' << 8);
    SAME(std::hex << static_cast<short>(-1) << ' ' << -1L << std::dec << static_cast<short>(-1));
    SAME(std::setw(8) << number << '|' << std::left << std::setw(8) << number << '|' << std::setw(4) << "x" << '|');
    SAME(std::setfill('*') << std::setw(9) << std::internal << number << '|' << std::setw(9) << -1.5 << '|' << std::right << std::setw(5) << 1);
    SAME(std::boolalpha << true << false << std::noboolalpha << true << std::showpos << 7 << ' ' << 0.5);
    SAME(0.1 << ' ' << 1.0 << ' ' << 1e10 << ' ' << 123456789.0 << ' ' << 1e-7 << ' ' << 0.1f << ' ' << 2.5L);
    SAME(std::fixed << 0.1 << ' ' << std::setprecision(3) << 2.0005 << ' ' << std::scientific << 12345.678 << ' ' << std::defaultfloat << 12345.678);
    SAME(std::setprecision(17) << 0.1 << ' ' << std::setprecision(0) << 0.5 << ' ' << std::showpoint << 1.0 << ' ' << std::hexfloat << 1.5);
    SAME(std::numeric_limits<double>::infinity() << -std::numeric_limits<double>::infinity() << std::numeric_limits<double>::quiet_NaN());
    SAME(own << std::setw(4) << own << kRed << std::complex<double>(1, 2) << std::bitset<4>(5) << std::setprecision(2) << std::complex<float>(1.234f, 2));
    SAME(ros::Time(5, 7) << ' ' << ros::Duration(-0.5) << ' ' << ros::Duration(3.25) << std::setw(6) << ros::Time(1, 2) << '|' << ros::WallTime(9, 0));
    SAME(static_cast<const void *>(&number) << ' ' << &number << ' ' << static_cast<void *>(nullptr) << std::endl << std::flush << std::dec << 1);
    SAME("outer " << nested() << " after " << 1.5);
    for (int i = 0; i < 20000; ++i)
    {
        const std::uint64_t bits = random();
        double              value;
        std::memcpy(&value, &bits, sizeof value);
        const int  width = static_cast<int>(random() % 25), precision = static_cast<int>(random() % 20);
        const auto whole = static_cast<long>(bits >> (bits & 63));
        SAME(std::setw(width) << value << ' ' << std::setprecision(precision) << value << ' ' << std::setw(width) << whole);
        SAME(std::fixed << std::setprecision(precision % 10) << static_cast<double>(whole % 1000000) / 1024 << std::scientific << value);
    }
    {
        roscfe::LogStream longest;
        for (int i = 0; i < 300; ++i)
        {
            longest << "0123456789";
        }
        compare(std::to_string(std::string(longest.text()).size()), "1023");
    }
    std::printf("%d lines, %d different\n", g_cases, g_different);
    return g_different == 0 ? 0 : 1;
}
