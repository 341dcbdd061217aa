// A name as a node gives it: text in quotes, std::string or a message's field. It is not copied, so it takes no memory.
#ifndef ROSCFE_NAME_H
#define ROSCFE_NAME_H

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "roscfe/fixed.h"

namespace roscfe
{

class Name
{
  public:
    Name(const char *text) : text_(text) {}
    Name(const std::string &text) : text_(text) {}
    Name(std::string_view text) : text_(text) {}
    template <std::size_t N>
    Name(const FixedString<N> &text) : text_(text.view())
    {
    }
    // What has a std::string in it, such as an XmlRpcValue.
    template <class T, class = decltype(std::declval<const T &>().operator const std::string &())>
    Name(const T &value) : text_(value.operator const std::string &())
    {
    }

    std::string_view view() const { return text_; }
    operator std::string_view() const { return text_; }
    std::string str() const { return std::string(text_); }

  private:
    std::string_view text_;
};

} // namespace roscfe

#endif
