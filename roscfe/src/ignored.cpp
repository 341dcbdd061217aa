// Packets that are none of their kind.
#include "internal.h"

namespace roscfe
{

void tell_ignored(Ignored what, std::uint16_t msg_id, std::size_t size)
{
    static const char *const kWhat[] = {"report of subscriptions", "request of a service", "answer of a service"};
    static bool              is_told[sizeof kWhat / sizeof *kWhat];
    const auto               number = static_cast<std::size_t>(what);
    if (!is_told[number])
    {
        is_told[number] = true;
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: ignored %lu bytes on 0x%04X: no %s; told once",
                          g_node.name.c_str(), as<unsigned long>(size), msg_id, kWhat[number]);
    }
}

} // namespace roscfe
