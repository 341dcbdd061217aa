// std::cout and its kin for nodes that do not include <iostream>, since roscpp's headers do: the header alone, without a use,
// would put 240 kB into an image. Those of standard_streams.cpp, which write and read where std's do, come with their first
// use.
#ifndef ROSCFE_STANDARD_STREAMS_H
#define ROSCFE_STANDARD_STREAMS_H

#include <iosfwd>
#include <istream>
#include <ostream>

#ifndef _GLIBCXX_IOSTREAM
namespace std
{
extern istream cin __asm__("roscfe_cin");
extern ostream cout __asm__("roscfe_cout");
extern ostream cerr __asm__("roscfe_cerr");
extern ostream clog __asm__("roscfe_clog");
} // namespace std
#endif

#endif
