// All but the smallest of Boost's headers include this one. A header that this folder lacks is found in the system's
// Boost, whose types are not ours; it must not compile by luck.
#ifndef BOOST_CONFIG_HPP_INCLUDED
#define BOOST_CONFIG_HPP_INCLUDED

#error "roscfe: a header of Boost that the interface library does not have [library-outside]"

#endif
