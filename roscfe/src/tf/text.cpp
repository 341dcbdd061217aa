// Texts in memory of a fixed size.
#include "roscfe/frames/text.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace roscfe
{
namespace frames
{

Text &Text::operator<<(std::string_view part)
{
    if (length_ + 1 < size_)
    {
        std::memcpy(to_ + length_, part.data(), std::min(part.size(), size_ - 1 - length_));
    }
    length_ += part.size();
    close();
    return *this;
}

Text &Text::operator<<(Fixed number)
{
    char      text[352]; // the longest double has 309 digits before the point
    const int length = std::snprintf(text, sizeof text, "%.*f", number.digits, number.value);
    return *this << std::string_view(text, static_cast<std::size_t>(length));
}

void Text::close()
{
    if (size_ > 0)
    {
        to_[std::min(length_, size_ - 1)] = '\0';
    }
}

} // namespace frames
} // namespace roscfe
