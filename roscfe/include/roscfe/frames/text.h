// Texts that are written into memory of a fixed size.
#ifndef ROSCFE_FRAMES_TEXT_H
#define ROSCFE_FRAMES_TEXT_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "roscfe/name.h"

namespace roscfe
{
namespace frames
{

using roscfe::Name;

// A number with so many digits behind the point.
struct Fixed
{
    double value;
    int    digits;
};

// Writes as snprintf does: what does not fit is cut, and length() says how long the whole is. Never allocates.
class Text
{
  public:
    Text(char *to, std::size_t size) : to_(to), size_(size) { close(); }

    Text &operator<<(std::string_view part);
    Text &operator<<(const char *part) { return *this << std::string_view(part); }
    Text &operator<<(Fixed number);

    std::size_t length() const { return length_; }

  private:
    void close();

    char *      to_;
    std::size_t size_;
    std::size_t length_ = 0;
};

// A text of any length as a std::string: `write(Text &)` writes it, once more where it is long.
template <class Write>
std::string text_of(const Write &write)
{
    char short_one[512];
    Text first(short_one, sizeof short_one);
    write(first);
    if (first.length() < sizeof short_one)
    {
        return std::string(short_one, first.length());
    }
    std::string long_one(first.length() + 1, '\0');
    Text        second(&long_one[0], long_one.size());
    write(second);
    long_one.pop_back();
    return long_one;
}

} // namespace frames
} // namespace roscfe

#endif
