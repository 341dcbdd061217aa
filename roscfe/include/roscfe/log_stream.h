// What ROS_INFO_STREAM and its kin write to in the profiles pool and strict: texts, numbers, times and std's manipulators,
// with the characters that std::ostream writes, in memory that is there. std::ostream, which brings 240 kB along, is used for
// types alone that have an operator of their own for it.
#ifndef ROSCFE_LOG_STREAM_H
#define ROSCFE_LOG_STREAM_H

#include <cstdint>
#include <iomanip>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>
#include <type_traits>

#include "ros/time.h"
#include "roscfe/format.h"

namespace roscfe
{

class LogStream
{
  public:
    LogStream();
    ~LogStream();
    LogStream(const LogStream &) = delete;
    LogStream &operator=(const LogStream &) = delete;

    // The text so far. What has no room in a line of a log is cut.
    const char *text();

    LogStream &operator<<(const char *value);
    LogStream &operator<<(const signed char *value) { return *this << reinterpret_cast<const char *>(value); }
    LogStream &operator<<(const unsigned char *value) { return *this << reinterpret_cast<const char *>(value); }
    LogStream &operator<<(const std::string &value) { return *this << std::string_view(value); }
    LogStream &operator<<(std::string_view value);
    LogStream &operator<<(char value) { return *this << std::string_view(&value, 1); }
    LogStream &operator<<(signed char value) { return *this << static_cast<char>(value); }
    LogStream &operator<<(unsigned char value) { return *this << static_cast<char>(value); }
    LogStream &operator<<(bool value);
    LogStream &operator<<(short value) { return put_signed(value, static_cast<unsigned short>(value)); }
    LogStream &operator<<(int value) { return put_signed(value, static_cast<unsigned>(value)); }
    LogStream &operator<<(long value) { return put_signed(value, static_cast<unsigned long>(value)); }
    LogStream &operator<<(long long value) { return put_signed(value, static_cast<unsigned long long>(value)); }
    LogStream &operator<<(unsigned short value) { return put_integer(value, false); }
    LogStream &operator<<(unsigned value) { return put_integer(value, false); }
    LogStream &operator<<(unsigned long value) { return put_integer(value, false); }
    LogStream &operator<<(unsigned long long value) { return put_integer(value, false); }
    LogStream &operator<<(float value) { return *this << static_cast<double>(value); }
    LogStream &operator<<(double value);
    LogStream &operator<<(long double value) { return *this << static_cast<double>(value); }
    LogStream &operator<<(const void *value);

    // Manipulators: std::hex, std::endl and so on, and those with a value.
    LogStream &operator<<(std::ios_base &(*manipulator)(std::ios_base &));
    LogStream &operator<<(std::ostream &(*manipulator)(std::ostream &));
    LogStream &operator<<(decltype(std::setw(0)) given) { return set_width(given._M_n); }
    LogStream &operator<<(decltype(std::setprecision(0)) given)
    {
        style_.precision = given._M_n;
        return *this;
    }
    LogStream &operator<<(decltype(std::setfill(' ')) given)
    {
        style_.fill = given._M_c;
        return *this;
    }

    template <class T>
    LogStream &operator<<(const T &value)
    {
        if constexpr (std::is_pointer<T>::value && !std::is_function<typename std::remove_pointer<T>::type>::value)
        {
            return *this << static_cast<const void *>(value);
        }
        else if constexpr (std::is_convertible<const T &, std::string_view>::value)
        {
            return *this << static_cast<std::string_view>(value); // texts of fixed capacity
        }
        else if constexpr (std::is_base_of<detail::Moment<T>, T>::value)
        {
            return print_on(*this, value);
        }
        else
        {
            Buffer       buffer(*this);
            std::ostream stream(&buffer);
            give_style(stream);
            stream << value;
            take_style(stream);
            return *this;
        }
    }

    // Of std::ostream, for those that print times.
    long width() const { return style_.width; }
    long width(long wanted)
    {
        const long before = style_.width;
        set_width(static_cast<int>(wanted));
        return before;
    }
    char fill(char wanted)
    {
        const char before = style_.fill;
        style_.fill       = wanted;
        return before;
    }

  private:
    // What std::ostream writes goes into the line, as it is.
    class Buffer : public std::streambuf
    {
      public:
        explicit Buffer(LogStream &to) : to_(to) {}

      protected:
        int_type overflow(int_type c) override
        {
            to_.put(traits_type::to_char_type(c));
            return c;
        }

      private:
        LogStream &to_;
    };

    LogStream &set_width(int width)
    {
        style_.width = width;
        return *this;
    }
    template <class T>
    LogStream &put_signed(T value, unsigned long long bits)
    {
        // In base 8 and 16 a negative number is the bits that it is kept in, as in std.
        return value < 0 && base_ == 10 ? put_integer(0 - static_cast<unsigned long long>(static_cast<long long>(value)), true)
                                        : put_integer(bits, false);
    }
    LogStream &put_integer(unsigned long long magnitude, bool negative);
    format::Style taken(); // the style for one value, which leaves no width behind
    void          put(char c);
    void          give_style(std::ios &to) const;
    void          take_style(const std::ios &from);

    enum class Floats : std::uint8_t
    {
        general,
        fixed,
        scientific,
        hexadecimal
    };

    format::Style style_;
    Floats        floats_    = Floats::general;
    unsigned      base_      = 10;
    bool          shows_base_ = false;
    bool          internal_  = false;
    bool          words_     = false; // std::boolalpha
    std::size_t   begin_;
    std::size_t   size_ = 0;
};

} // namespace roscfe

#endif
