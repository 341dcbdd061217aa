// What the core does for a part of the library that is tested without it: log lines go to the standard error.
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "ros/console.h"
#include "roscfe/refuse.h"

namespace roscfe
{

void refuse(const char *what, const char *detail)
{
    std::printf("refused: %s: %s\n", what, detail);
    std::fflush(stdout);
    std::_Exit(3);
}

namespace logging
{

bool is_enabled(int)
{
    return true;
}

bool is_due(double, std::int64_t &, bool)
{
    return true;
}

void print(int level, const char *, int, const char *, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    std::fputs(level == ros::console::levels::Error ? "Error:   " : "Warning: ", stderr);
    std::vfprintf(stderr, format, values);
    std::fputs("\n", stderr);
    va_end(values);
}

} // namespace logging
} // namespace roscfe
