// Which place a placeholder stands for; 0 for anything else.
#ifndef BOOST_IS_PLACEHOLDER_HPP_INCLUDED
#define BOOST_IS_PLACEHOLDER_HPP_INCLUDED

#include <functional>

namespace boost
{

using std::is_placeholder;

} // namespace boost

#endif
