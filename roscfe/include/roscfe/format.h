// Text without the C++ library's streams and without libc's printf, which are larger than all of this library together.
#ifndef ROSCFE_FORMAT_H
#define ROSCFE_FORMAT_H

#include <cstdarg>
#include <cstddef>

namespace roscfe
{
namespace format
{

// Characters that go into memory of a fixed size; those beyond it are counted only.
class Sink
{
  public:
    Sink(char *to, std::size_t room) : to_(to), room_(room) {}

    void put(char c)
    {
        if (size_ < room_)
        {
            to_[size_] = c;
        }
        ++size_;
    }
    void put(const char *text, std::size_t count);
    void repeat(char c, long count);

    std::size_t size() const { return size_; } // of all that was put

  private:
    char *      to_;
    std::size_t room_;
    std::size_t size_ = 0;
};

// How a value is written: the flags of printf, and of std::ios_base.
struct Style
{
    bool left      = false; // -
    bool plus      = false; // +
    bool space     = false;
    bool alternate = false; // #
    bool zero      = false; // 0
    bool upper     = false;
    int  width     = 0;
    int  precision = -1; // none
    char fill      = ' ';
    char inner     = '0'; // what `zero` puts between a sign and the digits
};

// Text that is filled up to the width.
void put_text(Sink &sink, const Style &style, const char *text, std::size_t size);
void put_integer(Sink &sink, const Style &style, unsigned long long magnitude, bool negative, unsigned base);

// As printf writes it, to the last digit. Kinds are e, f, g and a.
void put_double(Sink &sink, const Style &style, double value, char kind);

// As vsnprintf, but for %m, %n, wide characters and numbered arguments, which stay in the text as they are.
int print(char *to, std::size_t size, const char *form, std::va_list values);

// vsnprintf itself, where there is an operating system (posix/libc_format.cpp).
__attribute__((weak, visibility("hidden"))) int print_by_libc(char *to, std::size_t size, const char *form,
                                                              std::va_list values);

} // namespace format
} // namespace roscfe

#endif
