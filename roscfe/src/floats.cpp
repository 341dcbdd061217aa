// Floating-point numbers as text: all digits of a double are computed, and rounded once, to the nearest, ties to even.
#include <cmath>
#include <cstdint>
#include <cstring>

#include "roscfe/format.h"

namespace roscfe
{
namespace format
{

namespace
{

constexpr std::uint32_t kBase      = 1000000000; // of a word of nine decimal digits
constexpr int           kDigits    = 9;
constexpr int           kWhole     = 36;  // words of the largest double in front of the point
constexpr int           kWords     = 160; // and with those of the smallest behind it
constexpr int           kMantissa  = 52;
constexpr int           kBias      = 1075; // exponent of a mantissa that is a whole number
constexpr std::uint64_t kHidden    = std::uint64_t(1) << kMantissa;

struct Parts
{
    bool          negative;
    int           exponent; // as it is stored
    std::uint64_t mantissa;
};

Parts parts_of(double value)
{
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return {(bits >> 63) != 0, static_cast<int>(bits >> kMantissa & 0x7FF), bits & (kHidden - 1)};
}

// A number of decimal digits, all of them; positions count from the point: 0 is the first digit behind it, -1 the units.
class Decimal
{
  public:
    explicit Decimal(const Parts &parts)
    {
        const std::uint64_t mantissa = parts.exponent == 0 ? parts.mantissa : parts.mantissa | kHidden;
        const int           power    = (parts.exponent == 0 ? 1 : parts.exponent) - kBias;
        words_[kWhole - 1]           = static_cast<std::uint32_t>(mantissa % kBase);
        words_[kWhole - 2]           = static_cast<std::uint32_t>(mantissa / kBase);
        for (int left = power; left > 0; left -= kShiftUp)
        {
            multiply(left < kShiftUp ? left : kShiftUp);
        }
        for (int left = -power; left > 0; left -= kShiftDown)
        {
            divide(left < kShiftDown ? left : kShiftDown);
        }
    }

    unsigned digit(int position) const
    {
        const int at = position + kWhole * kDigits;
        if (at < 0 || at >= end_ * kDigits)
        {
            return 0;
        }
        std::uint32_t word = words_[at / kDigits];
        for (int i = at % kDigits; i < kDigits - 1; ++i)
        {
            word /= 10;
        }
        return word % 10;
    }

    // The position of the first digit that is not zero; of zero the units.
    int first() const
    {
        for (int word = 0; word < end_; ++word)
        {
            for (int i = 0; words_[word] != 0 && i < kDigits; ++i)
            {
                const int position = word * kDigits + i - kWhole * kDigits;
                if (digit(position) != 0)
                {
                    return position;
                }
            }
        }
        return -1;
    }

    // Leave no digit from a position on.
    void round(int position)
    {
        const unsigned next = digit(position);
        bool           up   = next > 5;
        if (next == 5)
        {
            up = digit(position - 1) % 2 != 0 || has_more(position + 1);
        }
        clear(position);
        for (int at = position - 1; up; --at)
        {
            up = digit(at) == 9;
            add(at, up ? -9 : 1);
        }
    }

  private:
    static constexpr int kShiftUp   = 29; // bits by which a word may grow at once
    static constexpr int kShiftDown = 9;  // 2 to the power of this divides the base

    void multiply(int bits)
    {
        std::uint64_t carry = 0;
        for (int i = kWhole - 1; i >= 0; --i)
        {
            carry += static_cast<std::uint64_t>(words_[i]) << bits;
            words_[i] = static_cast<std::uint32_t>(carry % kBase);
            carry /= kBase;
        }
    }

    void divide(int bits)
    {
        std::uint32_t carry = 0;
        for (int i = kWhole - 2; i < end_; ++i)
        {
            const std::uint32_t word = words_[i];
            words_[i]                = (word >> bits) + carry;
            carry                    = (kBase >> bits) * (word & ((1U << bits) - 1));
        }
        if (carry != 0)
        {
            words_[end_++] = carry;
        }
    }

    bool has_more(int position) const
    {
        for (int at = position; at < (end_ - kWhole) * kDigits; ++at)
        {
            if (digit(at) != 0)
            {
                return true;
            }
        }
        return false;
    }

    void clear(int position)
    {
        for (int at = position; at < (end_ - kWhole) * kDigits; ++at)
        {
            add(at, -static_cast<int>(digit(at)));
        }
    }

    void add(int position, int by)
    {
        const int at = position + kWhole * kDigits;
        if (at < 0 || at >= kWords * kDigits)
        {
            return;
        }
        std::int64_t unit = 1;
        for (int i = at % kDigits; i < kDigits - 1; ++i)
        {
            unit *= 10;
        }
        end_               = at / kDigits >= end_ ? at / kDigits + 1 : end_;
        words_[at / kDigits] = static_cast<std::uint32_t>(words_[at / kDigits] + by * unit);
    }

    std::uint32_t words_[kWords] = {};
    int           end_           = kWhole;
};

// A sign, and 0x of a hexadecimal one.
std::size_t put_lead(char (&lead)[3], const Style &style, bool negative)
{
    std::size_t size = 0;
    if (negative || style.plus || style.space)
    {
        lead[size++] = negative ? '-' : style.plus ? '+' : ' ';
    }
    return size;
}

int length_of(int number)
{
    int length = 1;
    for (int left = number; left >= 10; left /= 10)
    {
        ++length;
    }
    return length;
}

void put_number(Sink &sink, int number, int digits)
{
    int unit = 1;
    for (int i = 1; i < digits; ++i)
    {
        unit *= 10;
    }
    for (; unit > 0; unit /= 10)
    {
        sink.put(static_cast<char>('0' + number / unit % 10));
    }
}

// What stands before the digits, which are `size` characters.
void begin(Sink &sink, const Style &style, const char *lead, std::size_t lead_size, long size)
{
    const long pad = style.width - static_cast<long>(lead_size) - size;
    if (!style.left && !style.zero)
    {
        sink.repeat(style.fill, pad);
    }
    sink.put(lead, lead_size);
    if (!style.left && style.zero)
    {
        sink.repeat(style.inner, pad);
    }
}

void end(Sink &sink, const Style &style, std::size_t lead_size, long size)
{
    if (style.left)
    {
        sink.repeat(style.fill, style.width - static_cast<long>(lead_size) - size);
    }
}

// The last digit that is not zero, for %g: behind it nothing is written.
int trimmed(const Decimal &decimal, int from, int count)
{
    while (count > 0 && decimal.digit(from + count - 1) == 0)
    {
        --count;
    }
    return count;
}

void put_fixed(Sink &sink, const Style &style, const char *lead, std::size_t lead_size, const Decimal &decimal,
               int precision)
{
    const int  first = decimal.first();
    const int  whole = first < 0 ? -first : 1;
    const bool point = precision > 0 || style.alternate;
    const long size  = whole + (point ? 1 : 0) + precision;
    begin(sink, style, lead, lead_size, size);
    for (int at = -whole; at < precision; ++at)
    {
        if (at == 0)
        {
            sink.put('.');
        }
        sink.put(static_cast<char>('0' + decimal.digit(at)));
    }
    if (precision == 0 && point)
    {
        sink.put('.');
    }
    end(sink, style, lead_size, size);
}

void put_exponential(Sink &sink, const Style &style, const char *lead, std::size_t lead_size, const Decimal &decimal,
                     int precision, bool is_zero)
{
    const int  first    = decimal.first();
    const int  exponent = is_zero ? 0 : -first - 1;
    const int  distance = exponent < 0 ? -exponent : exponent;
    const int  digits   = distance < 10 ? 2 : length_of(distance);
    const bool point    = precision > 0 || style.alternate;
    const long size     = 1 + (point ? 1 : 0) + precision + 2 + digits;
    begin(sink, style, lead, lead_size, size);
    sink.put(static_cast<char>('0' + decimal.digit(first)));
    if (point)
    {
        sink.put('.');
    }
    for (int i = 1; i <= precision; ++i)
    {
        sink.put(static_cast<char>('0' + decimal.digit(first + i)));
    }
    sink.put(style.upper ? 'E' : 'e');
    sink.put(exponent < 0 ? '-' : '+');
    put_number(sink, distance, digits);
    end(sink, style, lead_size, size);
}

void put_shorter(Sink &sink, Style style, const char *lead, std::size_t lead_size, const Decimal &exact, int precision,
                 bool is_zero)
{
    const int significant = precision == 0 ? 1 : precision;
    Decimal   rounded     = exact;
    rounded.round(rounded.first() + significant);
    const int exponent = is_zero ? 0 : -rounded.first() - 1;
    if (exponent < -4 || exponent >= significant)
    {
        const int kept = style.alternate ? significant - 1 : trimmed(rounded, rounded.first() + 1, significant - 1);
        put_exponential(sink, style, lead, lead_size, rounded, kept, is_zero);
        return;
    }
    const int behind = significant - 1 - exponent;
    put_fixed(sink, style, lead, lead_size, rounded, style.alternate ? behind : trimmed(rounded, 0, behind));
}

// Hexadecimal: 0x1.8p+1.
void put_hexadecimal(Sink &sink, const Style &style, char (&lead)[3 + 2], std::size_t lead_size, const Parts &parts)
{
    const bool    is_zero  = parts.exponent == 0 && parts.mantissa == 0;
    int           exponent = is_zero ? 0 : (parts.exponent == 0 ? 1 : parts.exponent) - 1023;
    std::uint64_t mantissa = parts.mantissa | (parts.exponent != 0 ? kHidden : 0);
    int           digits   = kMantissa / 4;
    if (style.precision >= 0 && style.precision < digits)
    {
        const int           dropped = kMantissa - 4 * style.precision;
        const std::uint64_t half    = std::uint64_t(1) << (dropped - 1);
        const std::uint64_t rest    = mantissa & (2 * half - 1);
        mantissa -= rest;
        if (rest > half || (rest == half && (mantissa >> dropped & 1) != 0))
        {
            mantissa += 2 * half;
        }
        digits = style.precision;
    }
    while (style.precision < 0 && digits > 0 && (mantissa >> (kMantissa - 4 * digits) & 0xF) == 0)
    {
        --digits;
    }
    const char *const kSigns   = style.upper ? "0123456789ABCDEF" : "0123456789abcdef";
    const int         zeros    = style.precision > digits ? style.precision - digits : 0;
    const bool        point    = digits + zeros > 0 || style.alternate;
    const int         distance = exponent < 0 ? -exponent : exponent;
    const long        size     = 1 + (point ? 1 : 0) + digits + zeros + 2 + length_of(distance);
    lead[lead_size++]          = '0';
    lead[lead_size++]          = style.upper ? 'X' : 'x';
    begin(sink, style, lead, lead_size, size);
    sink.put(kSigns[mantissa >> kMantissa]);
    if (point)
    {
        sink.put('.');
    }
    for (int i = 1; i <= digits; ++i)
    {
        sink.put(kSigns[mantissa >> (kMantissa - 4 * i) & 0xF]);
    }
    sink.repeat('0', zeros);
    sink.put(style.upper ? 'P' : 'p');
    sink.put(exponent < 0 ? '-' : '+');
    put_number(sink, distance, length_of(distance));
    end(sink, style, lead_size, size);
}

} // namespace

void put_double(Sink &sink, const Style &style, double value, char kind)
{
    const Parts parts = parts_of(value);
    char        sign[3];
    std::size_t lead_size = put_lead(sign, style, parts.negative);
    char        lead[5];
    std::memcpy(lead, sign, sizeof sign);
    if (parts.exponent == 0x7FF)
    {
        const char *const word = parts.mantissa != 0 ? (style.upper ? "NAN" : "nan") : (style.upper ? "INF" : "inf");
        Style             plain = style;
        plain.zero              = false;
        begin(sink, plain, lead, lead_size, 3);
        sink.put(word, 3);
        end(sink, plain, lead_size, 3);
        return;
    }
    if (kind == 'a')
    {
        put_hexadecimal(sink, style, lead, lead_size, parts);
        return;
    }
    const int  precision = style.precision < 0 ? 6 : style.precision;
    const bool is_zero   = parts.exponent == 0 && parts.mantissa == 0;
    Decimal    decimal(parts);
    if (kind == 'g')
    {
        put_shorter(sink, style, lead, lead_size, decimal, precision, is_zero);
        return;
    }
    decimal.round(kind == 'e' ? decimal.first() + precision + 1 : precision);
    if (kind == 'e')
    {
        put_exponential(sink, style, lead, lead_size, decimal, precision, is_zero);
    }
    else
    {
        put_fixed(sink, style, lead, lead_size, decimal, precision);
    }
}

} // namespace format
} // namespace roscfe
