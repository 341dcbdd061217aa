// Commands of the ground, housekeeping, and marks in the performance log.
#include "roscfe/ground.h"

#include <cstring>

#include "internal.h"
#include "roscfe/heap.h"
#include "roscfe/parts.h"
#include "roscfe/refuse.h"

namespace roscfe
{

namespace parts
{
extern const char ground = 0;
} // namespace parts

namespace
{

using ground::Housekeeping;

std::uint8_t g_commands = 0;
std::uint8_t g_errors   = 0;

std::uint32_t count_of(std::size_t number)
{
    return static_cast<std::uint32_t>(number);
}

void send_housekeeping()
{
    Housekeeping values{};
    values.command_counter       = g_commands;
    values.command_error_counter = g_errors;
    values.received              = g_counters.received;
    values.dropped               = g_counters.dropped;
    values.bad                   = g_counters.bad;
    values.sent                  = g_counters.sent;
    values.not_sent              = g_counters.not_sent;
    values.callbacks_waiting     = count_of(g_node.queue.waiting());
    for (const boost::shared_ptr<Service> &each : g_node.services)
    {
        values.calls_waiting += count_of(each->waiting());
    }
    values.arena_bytes      = count_of(heap::capacity());
    values.arena_used       = count_of(heap::used());
    values.late_allocations = heap::late_allocations();
    CFE_SB_Buffer_t *buffer = begin_packet(g_node.description->housekeeping_msg_id, kTelemetryHeader + sizeof values);
    if (buffer != nullptr)
    {
        CFE_SB_TimeStampMsg(&buffer->Msg);
        std::memcpy(bytes_of(buffer) + kTelemetryHeader, &values, sizeof values);
        send_packet(buffer);
    }
}

void reject(const char *what, std::size_t size, CFE_MSG_FcnCode_t code)
{
    ++g_errors;
    CFE_EVS_SendEvent(kCommandEid, CFE_EVS_EventType_ERROR, "%s: command with %s: code %u, %lu bytes",
                      g_node.name.c_str(), what, static_cast<unsigned int>(code), as<unsigned long>(size));
}

} // namespace

void open_ground()
{
    const std::uint16_t msg_id = g_node.description->housekeeping_msg_id;
    if (msg_id != 0 && !listen(msg_id | kCommandBit))
    {
        refuse("the Software Bus has no room for the node's commands", g_node.description->app);
    }
    mark_work(true);
}

bool take_command(std::uint16_t msg_id, const CFE_SB_Buffer_t *buffer, std::size_t size)
{
    const std::uint16_t own = g_node.description->housekeeping_msg_id;
    if (own == 0 || msg_id != (own | kCommandBit))
    {
        return false;
    }
    CFE_MSG_FcnCode_t code = 0;
    CFE_MSG_GetFcnCode(&buffer->Msg, &code);
    if (size != kCommandHeader)
    {
        reject("a wrong length", size, code);
    }
    else if (code == ground::kSendHousekeepingCode)
    {
        send_housekeeping();
    }
    else if (code == ground::kNoopCode)
    {
        ++g_commands;
        CFE_EVS_SendEvent(kCommandEid, CFE_EVS_EventType_INFORMATION, "%s: no-op command", g_node.name.c_str());
    }
    else if (code == ground::kResetCountersCode)
    {
        g_counters = Counters();
        g_commands = g_errors = 0;
        CFE_EVS_SendEvent(kCommandEid, CFE_EVS_EventType_INFORMATION, "%s: counters reset", g_node.name.c_str());
    }
    else
    {
        reject("an unknown code", size, code);
    }
    return true;
}

void mark_work(bool begins)
{
    const std::uint16_t id = g_node.description->performance_id;
    if (id != kNoMarks)
    {
        begins ? CFE_ES_PerfLogEntry(id) : CFE_ES_PerfLogExit(id);
    }
}

} // namespace roscfe
