// A stand-in for cFE and OSAL, for one node that flies alone. A program with the stand-in in it may define the functions below;
// those that it leaves out are null.
#ifndef CFE_STAND_IN_H
#define CFE_STAND_IN_H

#include <cstddef>
#include <cstdint>

namespace stand_in
{

// Memory that is not the node's, which may have an arena in place of malloc.
void *outside_memory(std::size_t size);
void  outside_free(void *at);

// Put a packet into the node's pipe; false when the pipe is full, or has no subscription to its MsgId.
bool put(const std::uint8_t *packet, std::size_t size);

void advance(std::int64_t ns); // the clock

constexpr std::uint32_t kPipe = 0x00030001; // of the node

#define STAND_IN_HOOK __attribute__((weak))

STAND_IN_HOOK void fill();                                            // the pipe is empty, and is asked for a packet
STAND_IN_HOOK bool sent(const std::uint8_t *packet, std::size_t size); // the node's packet; false: it comes back to the node
STAND_IN_HOOK void event(const char *text);                           // in place of the standard error
STAND_IN_HOOK std::uint32_t other_subscription(std::size_t at);       // of other applications, when the node starts; 0 ends them
STAND_IN_HOOK bool has_pipe(std::uint32_t pipe);                      // whether another application has it
STAND_IN_HOOK bool has_queue(const char *name, std::uint32_t id);     // whether OSAL has a queue; by name, or by id
STAND_IN_HOOK bool load(char *table, std::size_t size);               // whether the ground has loaded the table

} // namespace stand_in

#endif
