// roscfe/format.h beside libc's printf: random numbers in random forms, and the same texts.
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include "roscfe/format.h"

namespace
{

std::mt19937_64 g_random(20240229);
long            g_cases = 0, g_different = 0;

std::string by_libc(const char *form, ...)
{
    char    text[4096];
    va_list values;
    va_start(values, form);
    const int size = std::vsnprintf(text, sizeof text, form, values);
    va_end(values);
    return std::to_string(size) + ":" + text;
}

std::string by_us(const char *form, ...)
{
    char    text[4096];
    va_list values;
    va_start(values, form);
    const int size = roscfe::format::print(text, sizeof text, form, values);
    va_end(values);
    return std::to_string(size) + ":" + text;
}

void compare(const std::string &form, const std::string &found, const std::string &wanted)
{
    ++g_cases;
    if (found != wanted && g_different++ < 20)
    {
        std::printf("%s: [%s] and not [%s]\n", form.c_str(), found.c_str(), wanted.c_str());
    }
}

std::uint64_t number(std::uint64_t below)
{
    return g_random() % below;
}

std::string form_of(const char *kinds, const char *flags, const char *size)
{
    std::string form = "<%";
    for (const char *flag = flags; *flag != '\0'; ++flag)
    {
        form += number(4) == 0 ? std::string(1, *flag) : std::string();
    }
    form += number(2) == 0 ? std::to_string(number(30) + 1) : std::string();
    form += number(2) == 0 ? "." + std::to_string(number(number(8) == 0 ? 400 : 20)) : std::string();
    return form + size + kinds[number(std::strlen(kinds))] + ">";
}

double random_double()
{
    static const double kPlain[] = {0.0, -0.0, 1.0, 0.5, 1.5, 2.5, 0.125, 9.5, 99.5, 999999.5, 9999995.0, 1e-5, 0.0001, 1e6,
                                    1e15, 1e16, 1e17, 1e22, 1e23, 5e-324, 1.7976931348623157e308, 2.2250738585072014e-308,
                                    std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()};
    if (number(3) == 0)
    {
        const double value = kPlain[number(sizeof kPlain / sizeof *kPlain)];
        return number(2) == 0 ? value : -value;
    }
    if (number(2) == 0)
    {
        return static_cast<double>(static_cast<std::int64_t>(number(2000001)) - 1000000) / static_cast<double>(1 << number(12));
    }
    const std::uint64_t bits = g_random();
    double              value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

} // namespace

int main(int, char **arguments)
{
    const long rounds = std::atol(arguments[1]);
    for (long i = 0; i < rounds; ++i)
    {
        const double      value = random_double();
        // glibc leaves the zeros out that # asks for where %g rounds up to a power of ten: 1.e+06 of 999999.5.
        const bool        is_general = number(4) == 0;
        const std::string form       = is_general ? form_of("gG", "-+ 0", "") : form_of("eEfFaA", "-+ #0", "");
        compare(form, by_us(form.c_str(), value), by_libc(form.c_str(), value));
        const std::uint64_t bits  = g_random() >> number(64);
        const std::string   whole = form_of("di", "-+ 0", "ll");
        compare(whole, by_us(whole.c_str(), bits), by_libc(whole.c_str(), bits));
        const std::string other = form_of("uoxX", "-#0", "ll");
        compare(other, by_us(other.c_str(), bits), by_libc(other.c_str(), bits));
        for (const char *size : {"", "h", "hh"})
        {
            const std::string small = form_of("di", "-+ 0", size);
            compare(small, by_us(small.c_str(), static_cast<int>(bits)), by_libc(small.c_str(), static_cast<int>(bits)));
            const std::string least = form_of("uoxX", "-#0", size);
            compare(least, by_us(least.c_str(), static_cast<int>(bits)), by_libc(least.c_str(), static_cast<int>(bits)));
        }
        const std::string longer = form_of("eEfF", "-+ #0", "L");
        const auto        longest = static_cast<long double>(value);
        compare(longer, by_us(longer.c_str(), longest), by_libc(longer.c_str(), longest));
        for (const char *size : {"l", "z", "j", "t"})
        {
            const std::string word = form_of("dux", "-", size);
            compare(word, by_us(word.c_str(), static_cast<long>(bits)), by_libc(word.c_str(), static_cast<long>(bits)));
        }
        const std::string text = form_of("s", "-", "");
        compare(text, by_us(text.c_str(), "a text"), by_libc(text.c_str(), "a text"));
        const int width = 12 - static_cast<int>(number(24)), precision = static_cast<int>(number(9)) - 1;
        compare("%*.*f", by_us("%*.*f|%-*d", width, precision, value, 5, 7),
                by_libc("%*.*f|%-*d", width, precision, value, 5, 7));
    }
    compare("%c%%%p", by_us("%c%%%5c|%-4c|%p|%20p", 'a', 'b', 'c', nullptr, reinterpret_cast<void *>(0x1234)),
            by_libc("%c%%%5c|%-4c|%p|%20p", 'a', 'b', 'c', nullptr, reinterpret_cast<void *>(0x1234)));
    for (const char *form : {"%s", "%9s|%-9s", "%.5s", "%.6s"})
    {
        compare(form, by_us(form, nullptr, nullptr), by_libc(form, nullptr, nullptr));
    }
    compare("%y", by_us("%y %-5w|%d", 7), by_libc("%y %-5w|%d", 7));
    compare("length", by_us("%.0d%.0o%#.0o%#o", 0, 0, 0, 8), by_libc("%.0d%.0o%#.0o%#o", 0, 0, 0, 8));
    char cut[8], other[8];
    const int ours   = [](char *to, ...) {
        va_list none;
        va_start(none, to);
        const int size = roscfe::format::print(to, 8, "0123456789", none);
        va_end(none);
        return size;
    }(cut);
    const int theirs = std::snprintf(other, sizeof other, "%s", "0123456789");
    compare("cut", std::to_string(ours) + cut, std::to_string(theirs) + other);
    std::printf("%ld texts, %ld different\n", g_cases, g_different);
    return g_different == 0 ? 0 : 1;
}
