// Text, whole numbers, and printf's language.
#include "roscfe/format.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace roscfe
{
namespace format
{

namespace
{

constexpr std::size_t kLongestInteger = 64 / 3 + 2; // digits of base 8
constexpr int         kMostWidth      = 1 << 20;

enum class Size : std::uint8_t
{
    plain,
    tiny,    // hh
    small,   // h
    wide,    // l
    widest,  // ll
    most,    // j
    memory,  // z
    distance // t
};

std::size_t length_up_to(const char *text, std::size_t most)
{
    std::size_t size = 0;
    while (size < most && text[size] != '\0')
    {
        ++size;
    }
    return size;
}

// Where a number in the form ends, and its value.
const char *read_number(const char *at, int &number)
{
    number = 0;
    for (; *at >= '0' && *at <= '9'; ++at)
    {
        number = number < kMostWidth ? 10 * number + (*at - '0') : number;
    }
    return at;
}

// A copy of the list of arguments that functions may go on with.
struct Values
{
    std::va_list list;
};

const char *read_flags(const char *at, Style &style)
{
    for (;; ++at)
    {
        switch (*at)
        {
        case '-':
            style.left = true;
            break;
        case '+':
            style.plus = true;
            break;
        case ' ':
            style.space = true;
            break;
        case '#':
            style.alternate = true;
            break;
        case '0':
            style.zero = true;
            break;
        default:
            return at;
        }
    }
}

const char *read_width(const char *at, Style &style, Values &values)
{
    if (*at == '*')
    {
        const int width = va_arg(values.list, int);
        style.left      = style.left || width < 0;
        style.width     = width < 0 ? -width : width;
        ++at;
    }
    else
    {
        at = read_number(at, style.width);
    }
    if (*at != '.')
    {
        return at;
    }
    if (at[1] == '*')
    {
        style.precision = va_arg(values.list, int);
        return at + 2;
    }
    return read_number(at + 1, style.precision);
}

const char *read_size(const char *at, Size &size)
{
    switch (*at)
    {
    case 'h':
        size = at[1] == 'h' ? Size::tiny : Size::small;
        return at + (at[1] == 'h' ? 2 : 1);
    case 'l':
        size = at[1] == 'l' ? Size::widest : Size::wide;
        return at + (at[1] == 'l' ? 2 : 1);
    case 'L':
    case 'q':
        size = Size::widest;
        return at + 1;
    case 'j':
        size = Size::most;
        return at + 1;
    case 'z':
        size = Size::memory;
        return at + 1;
    case 't':
        size = Size::distance;
        return at + 1;
    default:
        return at;
    }
}

long long signed_value(Values &values, Size size)
{
    switch (size)
    {
    case Size::tiny:
        return static_cast<signed char>(va_arg(values.list, int));
    case Size::small:
        return static_cast<short>(va_arg(values.list, int));
    case Size::wide:
        return va_arg(values.list, long);
    case Size::widest:
        return va_arg(values.list, long long);
    case Size::most:
        return static_cast<long long>(va_arg(values.list, std::intmax_t));
    case Size::memory:
    case Size::distance:
        return static_cast<long long>(va_arg(values.list, std::ptrdiff_t));
    default:
        return va_arg(values.list, int);
    }
}

unsigned long long unsigned_value(Values &values, Size size)
{
    switch (size)
    {
    case Size::tiny:
        return static_cast<unsigned char>(va_arg(values.list, unsigned));
    case Size::small:
        return static_cast<unsigned short>(va_arg(values.list, unsigned));
    case Size::wide:
        return va_arg(values.list, unsigned long);
    case Size::widest:
        return va_arg(values.list, unsigned long long);
    case Size::most:
        return static_cast<unsigned long long>(va_arg(values.list, std::uintmax_t));
    case Size::memory:
    case Size::distance:
        return static_cast<unsigned long long>(va_arg(values.list, std::size_t));
    default:
        return va_arg(values.list, unsigned);
    }
}

void put_pointer(Sink &sink, Style style, const void *pointer)
{
    if (pointer == nullptr)
    {
        put_text(sink, style, "(nil)", 5);
        return;
    }
    style.alternate = true;
    put_integer(sink, style, reinterpret_cast<std::uintptr_t>(pointer), false, 16);
}

void put_string(Sink &sink, const Style &style, const char *text)
{
    const std::size_t most = style.precision < 0 ? static_cast<std::size_t>(-1) : static_cast<std::size_t>(style.precision);
    if (text == nullptr)
    {
        put_text(sink, style, "(null)", most < 6 ? 0 : 6);
        return;
    }
    put_text(sink, style, text, length_up_to(text, most));
}

// One conversion; false when there is none of this kind.
bool put_value(Sink &sink, Style style, Size size, char kind, Values &values)
{
    style.upper = kind == 'X' || kind == 'E' || kind == 'F' || kind == 'G' || kind == 'A';
    switch (kind)
    {
    case 'd':
    case 'i': {
        const long long value = signed_value(values, size);
        const auto      whole = static_cast<unsigned long long>(value);
        put_integer(sink, style, value < 0 ? 0 - whole : whole, value < 0, 10);
        return true;
    }
    case 'u':
    case 'o':
    case 'x':
    case 'X':
        style.plus = style.space = false;
        put_integer(sink, style, unsigned_value(values, size), false, kind == 'u' ? 10 : kind == 'o' ? 8 : 16);
        return true;
    case 'c': {
        const char c = static_cast<char>(va_arg(values.list, int));
        put_text(sink, style, &c, 1);
        return true;
    }
    case 's':
        put_string(sink, style, va_arg(values.list, const char *));
        return true;
    case 'p':
        put_pointer(sink, style, va_arg(values.list, void *));
        return true;
    case 'e':
    case 'E':
    case 'f':
    case 'F':
    case 'g':
    case 'G':
    case 'a':
    case 'A': {
        const double value = size == Size::widest ? static_cast<double>(va_arg(values.list, long double))
                                                  : va_arg(values.list, double);
        put_double(sink, style, value, static_cast<char>(style.upper ? kind - 'A' + 'a' : kind));
        return true;
    }
    default:
        return false;
    }
}

} // namespace

void Sink::put(const char *text, std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        put(text[i]);
    }
}

void Sink::repeat(char c, long count)
{
    for (long i = 0; i < count; ++i)
    {
        put(c);
    }
}

void put_text(Sink &sink, const Style &style, const char *text, std::size_t size)
{
    const long pad = style.width - static_cast<long>(size);
    sink.repeat(style.fill, style.left ? 0 : pad);
    sink.put(text, size);
    sink.repeat(style.fill, style.left ? pad : 0);
}

void put_integer(Sink &sink, const Style &style, unsigned long long magnitude, bool negative, unsigned base)
{
    const char *const signs = style.upper ? "0123456789ABCDEF" : "0123456789abcdef";
    char              digits[kLongestInteger];
    std::size_t       first = sizeof digits;
    for (unsigned long long left = magnitude; left != 0; left /= base)
    {
        digits[--first] = signs[left % base];
    }
    const auto count = static_cast<int>(sizeof digits - first);
    int        zeros = style.precision < 0 ? (count == 0 ? 1 : 0) : style.precision - count;
    if (base == 8 && style.alternate && zeros <= 0)
    {
        zeros = count == 0 || digits[first] != '0' ? 1 : 0;
    }
    char        lead[3];
    std::size_t lead_size = 0;
    if (negative || style.plus || style.space)
    {
        lead[lead_size++] = negative ? '-' : style.plus ? '+' : ' ';
    }
    if (base == 16 && style.alternate && magnitude != 0)
    {
        lead[lead_size++] = '0';
        lead[lead_size++] = style.upper ? 'X' : 'x';
    }
    zeros          = zeros > 0 ? zeros : 0;
    const long pad = style.width - static_cast<long>(lead_size) - zeros - count;
    const bool inside = style.zero && style.precision < 0;
    sink.repeat(style.fill, style.left || inside ? 0 : pad);
    sink.put(lead, lead_size);
    sink.repeat(style.inner, inside && !style.left ? pad : 0);
    sink.repeat('0', zeros);
    sink.put(digits + first, static_cast<std::size_t>(count));
    if (style.left)
    {
        sink.repeat(style.fill, pad);
    }
}

int print(char *to, std::size_t size, const char *form, std::va_list given)
{
    Sink   sink(to, size > 0 ? size - 1 : 0);
    Values values;
    va_copy(values.list, given);
    for (const char *at = form; *at != '\0';)
    {
        if (*at != '%')
        {
            sink.put(*at++);
            continue;
        }
        Style       style;
        Size        of_value = Size::plain;
        const char *next     = read_size(read_width(read_flags(at + 1, style), style, values), of_value);
        if (*next == '%')
        {
            sink.put('%');
        }
        else if (*next == '\0' || !put_value(sink, style, of_value, *next, values))
        {
            sink.put(at, static_cast<std::size_t>(next - at)); // and what follows, as it is
            at = next;
            continue;
        }
        at = next + 1;
    }
    va_end(values.list);
    if (size > 0)
    {
        to[sink.size() < size ? sink.size() : size - 1] = '\0';
    }
    return static_cast<int>(sink.size());
}

} // namespace format
} // namespace roscfe
