// Parts of the library that an image has when a node needs them. Most come with the functions that a node calls; those
// named here are called by the library alone, where the node, its headers or its entry point have asked for them.
#ifndef ROSCFE_PARTS_H
#define ROSCFE_PARTS_H

#include <cstddef>

namespace roscfe
{
namespace parts
{

extern const char subscribers;        // who listens: what nobody hears is not sent
extern const char latching;           // messages for subscribers that come later, callbacks that are told of subscribers
extern const char long_messages;      // in several packets, or raw
extern const char exact_waits;        // of less than a millisecond
extern const char parameters;         // the table, with what a launch file has put into it
extern const char private_parameters; // "_name:=value"
extern const char parameter_server;   // that of cfepy
extern const char sim_time;           // /use_sim_time
extern const char ground;             // commands, housekeeping, marks in the performance log

// The linker adds a part to the image.
inline void need(const char &part)
{
    __asm__ volatile("" : : "r"(&part));
}

constexpr std::size_t kSurelyInPacket = 1024; // bytes of a message that no configuration of cFE divides

// A message has so many bytes at most, or 0 when nobody knows.
template <std::size_t most_bytes>
void need_room()
{
    if constexpr (most_bytes == 0 || most_bytes > kSurelyInPacket)
    {
        need(long_messages);
    }
}

} // namespace parts
} // namespace roscfe

#endif
