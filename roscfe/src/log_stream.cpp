// Lines of a log that are put together with <<.
#include "roscfe/log_stream.h"

namespace roscfe
{

namespace
{

// A line that is put together while another one is, since a function in it logs, is put behind that.
constexpr std::size_t kRoom = 1024;
char                  g_lines[kRoom];
std::size_t           g_end = 0;

} // namespace

LogStream::LogStream() : begin_(g_end)
{
    style_.precision = 6;
}

LogStream::~LogStream()
{
    g_end = begin_;
}

const char *LogStream::text()
{
    const std::size_t end = begin_ + size_ < kRoom ? begin_ + size_ : kRoom - 1;
    g_lines[end]          = '\0';
    g_end                 = end + 1 < kRoom ? end + 1 : kRoom - 1;
    return g_lines + begin_;
}

void LogStream::put(char c)
{
    if (begin_ + size_ < kRoom - 1)
    {
        g_lines[begin_ + size_++] = c;
        g_end                     = begin_ + size_;
    }
}

format::Style LogStream::taken()
{
    const format::Style style = style_;
    style_.width              = 0;
    return style;
}

namespace
{

// Writes one value into the line.
template <class F>
void write_into(std::size_t begin, std::size_t &size, F write)
{
    const std::size_t left = kRoom - 1 - begin - size;
    format::Sink      sink(g_lines + begin + size, left);
    write(sink);
    size += sink.size() < left ? sink.size() : left;
    g_end = begin + size;
}

} // namespace

LogStream &LogStream::operator<<(const char *value)
{
    return *this << (value != nullptr ? std::string_view(value) : std::string_view());
}

LogStream &LogStream::operator<<(std::string_view value)
{
    const format::Style style = taken();
    write_into(begin_, size_, [&](format::Sink &sink) { format::put_text(sink, style, value.data(), value.size()); });
    return *this;
}

LogStream &LogStream::operator<<(bool value)
{
    return words_ ? *this << (value ? "true" : "false") : put_integer(value ? 1 : 0, false);
}

LogStream &LogStream::put_integer(unsigned long long magnitude, bool negative)
{
    format::Style style = taken();
    style.precision     = -1;
    style.alternate     = shows_base_;
    style.plus          = style.plus && base_ == 10;
    style.zero          = internal_;
    style.inner         = style.fill;
    write_into(begin_, size_, [&](format::Sink &sink) { format::put_integer(sink, style, magnitude, negative, base_); });
    return *this;
}

LogStream &LogStream::operator<<(double value)
{
    static const char kKinds[] = {'g', 'f', 'e', 'a'};
    format::Style     style    = taken();
    const char        kind     = kKinds[static_cast<std::size_t>(floats_)];
    style.precision            = kind == 'a' ? -1 : style.precision;
    style.zero                 = internal_;
    style.inner                = style.fill;
    write_into(begin_, size_, [&](format::Sink &sink) { format::put_double(sink, style, value, kind); });
    return *this;
}

LogStream &LogStream::operator<<(const void *value)
{
    format::Style style = taken();
    style.precision     = -1;
    style.plus          = false;
    style.alternate     = true;
    write_into(begin_, size_, [&](format::Sink &sink) {
        format::put_integer(sink, style, reinterpret_cast<std::uintptr_t>(value), false, 16);
    });
    return *this;
}

LogStream &LogStream::operator<<(std::ostream &(*manipulator)(std::ostream &))
{
    std::ostream &(*const line)(std::ostream &) = std::endl;
    std::ostream &(*const zero)(std::ostream &) = std::ends;
    if (manipulator == line || manipulator == zero)
    {
        put(manipulator == line ? '\n' : '\0');
    }
    return *this;
}

LogStream &LogStream::operator<<(std::ios_base &(*manipulator)(std::ios_base &))
{
    typedef std::ios_base &(*Manipulator)(std::ios_base &);
    static const struct
    {
        Manipulator is;
        bool        LogStream::*flag;
        bool                    value;
    } kFlags[] = {
        {std::boolalpha, &LogStream::words_, true},       {std::noboolalpha, &LogStream::words_, false},
        {std::showbase, &LogStream::shows_base_, true},   {std::noshowbase, &LogStream::shows_base_, false},
    };
    static const struct
    {
        Manipulator is;
        bool        format::Style::*flag;
        bool                        value;
    } kStyles[] = {
        {std::showpoint, &format::Style::alternate, true}, {std::noshowpoint, &format::Style::alternate, false},
        {std::showpos, &format::Style::plus, true},        {std::noshowpos, &format::Style::plus, false},
        {std::uppercase, &format::Style::upper, true},     {std::nouppercase, &format::Style::upper, false},
    };
    static const struct
    {
        Manipulator is;
        unsigned    base;
    } kBases[] = {{std::dec, 10}, {std::hex, 16}, {std::oct, 8}};
    static const struct
    {
        Manipulator is;
        Floats      floats;
    } kFloats[] = {{std::fixed, Floats::fixed},
                   {std::scientific, Floats::scientific},
                   {std::hexfloat, Floats::hexadecimal},
                   {std::defaultfloat, Floats::general}};
    for (const auto &each : kFlags)
    {
        this->*each.flag = manipulator == each.is ? each.value : this->*each.flag;
    }
    for (const auto &each : kStyles)
    {
        style_.*each.flag = manipulator == each.is ? each.value : style_.*each.flag;
    }
    for (const auto &each : kBases)
    {
        base_ = manipulator == each.is ? each.base : base_;
    }
    for (const auto &each : kFloats)
    {
        floats_ = manipulator == each.is ? each.floats : floats_;
    }
    if (manipulator == std::left || manipulator == std::right || manipulator == std::internal)
    {
        style_.left = manipulator == std::left;
        internal_   = manipulator == std::internal;
    }
    return *this;
}

// -- values that std::ostream writes -----------------------------------------------------------------------------------

void LogStream::give_style(std::ios &to) const
{
    to.width(style_.width);
    to.precision(style_.precision);
    to.fill(style_.fill);
    const struct
    {
        bool                    is_set;
        std::ios_base::fmtflags flag;
    } kFlags[] = {{words_, std::ios_base::boolalpha},
                  {shows_base_, std::ios_base::showbase},
                  {style_.alternate, std::ios_base::showpoint},
                  {style_.plus, std::ios_base::showpos},
                  {style_.upper, std::ios_base::uppercase},
                  {style_.left, std::ios_base::left},
                  {internal_, std::ios_base::internal},
                  {floats_ == Floats::fixed || floats_ == Floats::hexadecimal, std::ios_base::fixed},
                  {floats_ == Floats::scientific || floats_ == Floats::hexadecimal, std::ios_base::scientific}};
    std::ios_base::fmtflags flags = base_ == 16 ? std::ios_base::hex : base_ == 8 ? std::ios_base::oct : std::ios_base::dec;
    for (const auto &each : kFlags)
    {
        flags |= each.is_set ? each.flag : std::ios_base::fmtflags();
    }
    to.flags(flags);
}

void LogStream::take_style(const std::ios &from)
{
    const std::ios_base::fmtflags flags = from.flags();
    const auto                    has   = [flags](std::ios_base::fmtflags flag) { return (flags & flag) != 0; };
    style_.width     = static_cast<int>(from.width());
    style_.precision = static_cast<int>(from.precision());
    style_.fill      = from.fill();
    words_           = has(std::ios_base::boolalpha);
    shows_base_      = has(std::ios_base::showbase);
    style_.alternate = has(std::ios_base::showpoint);
    style_.plus      = has(std::ios_base::showpos);
    style_.upper     = has(std::ios_base::uppercase);
    style_.left      = has(std::ios_base::left);
    internal_        = has(std::ios_base::internal);
    base_            = has(std::ios_base::hex) ? 16 : has(std::ios_base::oct) ? 8 : 10;
    floats_ = has(std::ios_base::fixed) ? (has(std::ios_base::scientific) ? Floats::hexadecimal : Floats::fixed)
                                        : (has(std::ios_base::scientific) ? Floats::scientific : Floats::general);
}

} // namespace roscfe
