// What the ground has of a node: commands, and a packet of housekeeping that they ask for.
#ifndef ROSCFE_GROUND_H
#define ROSCFE_GROUND_H

#include <cstdint>

namespace roscfe
{
namespace ground
{

// Function codes of the commands. None has arguments.
constexpr std::uint16_t kNoopCode             = 0; // an event, and no more
constexpr std::uint16_t kResetCountersCode    = 1; // those of the packet below begin anew at 0
constexpr std::uint16_t kSendHousekeepingCode = 2; // is not counted

// The packet behind its telemetry header, in the byte order of the processor.
struct Housekeeping
{
    std::uint8_t  command_counter;
    std::uint8_t  command_error_counter; // another code, or another length
    std::uint8_t  spare[2];
    std::uint32_t received;          // messages of topics that the node subscribes
    std::uint32_t dropped;           // messages and requests for which a queue had no room
    std::uint32_t bad;               // packets that were no message of their topic
    std::uint32_t sent;              // packets
    std::uint32_t not_sent;          // packets for which the Software Bus had no memory, or which it refused
    std::uint32_t callbacks_waiting; // in the node's queue at the moment
    std::uint32_t calls_waiting;     // requests of services at the moment
    std::uint32_t arena_bytes;       // of the node's heap; 0 in the profile host
    std::uint32_t arena_used;        // the most of it that was in use at any time
    std::uint32_t late_allocations;  // since the first spin
};

} // namespace ground

// What is counted for it.
struct Counters
{
    std::uint32_t received = 0;
    std::uint32_t dropped  = 0;
    std::uint32_t bad      = 0;
    std::uint32_t sent     = 0;
    std::uint32_t not_sent = 0;
};
extern Counters g_counters;

} // namespace roscfe

#endif
