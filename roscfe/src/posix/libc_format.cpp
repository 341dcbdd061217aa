// On a computer with an operating system libc is there anyway, and its printf knows all conversions.
#include <cstdarg>
#include <cstdio>

#include "roscfe/format.h"

namespace roscfe
{
namespace format
{

int print_by_libc(char *to, std::size_t size, const char *form, std::va_list values)
{
    return std::vsnprintf(to, size, form, values);
}

} // namespace format
} // namespace roscfe
