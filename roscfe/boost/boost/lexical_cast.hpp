// boost::lexical_cast: a value of one type from the text of another.
#ifndef BOOST_LEXICAL_CAST_HPP_INCLUDED
#define BOOST_LEXICAL_CAST_HPP_INCLUDED

#include <limits>
#include <sstream>
#include <string>
#include <type_traits>
#include <typeinfo>

#include "roscfe/refuse.h"

namespace boost
{

class bad_lexical_cast : public std::bad_cast
{
  public:
    const char *what() const noexcept override
    {
        return "bad lexical cast: source type value could not be interpreted as target";
    }
};

template <class Target, class Source>
Target lexical_cast(const Source &source)
{
    std::stringstream text;
    text.precision(std::numeric_limits<long double>::digits10);
    if (std::is_floating_point<Source>::value)
    {
        text.precision(std::is_same<Source, float>::value ? 9 : 17);
    }
    text << source;
    if constexpr (std::is_same<Target, std::string>::value)
    {
        return text.str();
    }
    else
    {
        Target target{};
        const bool is_negative = std::is_unsigned<Target>::value && text.str().find('-') != std::string::npos;
        if (is_negative || !(text >> std::noskipws >> target) || text.peek() != std::char_traits<char>::eof())
        {
            ROSCFE_THROW(bad_lexical_cast());
        }
        return target;
    }
}

} // namespace boost

#endif
