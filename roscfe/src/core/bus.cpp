// The node's pipe: what comes through it, and packets that go out (CFE_SB).
#include <algorithm>
#include <cstring>

#include "core.h"
#include "roscfe/refuse.h"

namespace roscfe
{

Counters g_counters;

namespace
{

static_assert(kTelemetryHeader == 16, "topics have packets with a header of 16 bytes, as cfepy's have");

constexpr std::size_t  kSpare         = 12;   // of a telemetry header: whom a repetition is for
constexpr std::uint8_t kAddressed     = 0x01; // in its last byte; above it stands which subscription is meant
constexpr std::int32_t kLongestWaitMs = 100000;

std::uint32_t g_addressee   = 0; // of what is sent at the moment; 0 is everybody
std::uint8_t  g_number      = 0; // of its subscription
bool          g_dispatching = false;

// While one packet is given to whom it is for, no other is taken over.
struct Dispatching
{
    Dispatching() : outer(g_dispatching) { g_dispatching = true; }
    ~Dispatching() { g_dispatching = outer; }
    Dispatching(const Dispatching &) = delete;
    Dispatching &operator=(const Dispatching &) = delete;

    const bool outer;
};

// Whether a packet is a report or of a service.
bool take_other(std::uint16_t msg_id, const CFE_SB_Buffer_t *buffer, std::size_t size)
{
    const std::uint8_t *packet = reinterpret_cast<const std::uint8_t *>(buffer);
    return (take_report != nullptr && take_report(msg_id, buffer, size)) ||
           (take_command != nullptr && take_command(msg_id, buffer, size)) ||
           (take_request != nullptr && take_request(msg_id, packet, size)) ||
           (take_answer != nullptr && take_answer(msg_id, packet, size));
}

void dispatch(const CFE_SB_Buffer_t *buffer)
{
    const Dispatching          dispatching;
    CFE_SB_MsgId_t             id   = CFE_SB_INVALID_MSG_ID;
    CFE_MSG_Size_t             size = 0;
    CFE_MSG_SegmentationFlag_t flag = CFE_MSG_SegFlag_Unsegmented;
    CFE_MSG_GetMsgId(&buffer->Msg, &id);
    CFE_MSG_GetSize(&buffer->Msg, &size);
    CFE_MSG_GetSegmentationFlag(&buffer->Msg, &flag);
    const auto          msg_id = static_cast<std::uint16_t>(CFE_SB_MsgIdToValue(id));
    const std::uint8_t *packet = reinterpret_cast<const std::uint8_t *>(buffer);
    if (take_other(msg_id, buffer, size))
    {
        return;
    }
    int number = kAll;
    if (size >= kTelemetryHeader && (packet[kSpare + 3] & kAddressed) != 0)
    {
        number = packet[kSpare + 3] >> 1;
        const std::uint32_t whom = static_cast<std::uint32_t>(packet[kSpare]) << 16 |
                                   static_cast<std::uint32_t>(packet[kSpare + 1]) << 8 | packet[kSpare + 2];
        if (whom != (static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(g_node.pipe)) & 0x00FFFFFF))
        {
            return;
        }
    }
    if (flag == CFE_MSG_SegFlag_Unsegmented)
    {
        give_to_subscriptions(msg_id, packet, size, number);
    }
    else if (take_piece != nullptr && size >= kTelemetryHeader)
    {
        take_piece(msg_id, packet, size, flag, number);
    }
}

void queue_timers()
{
    if (queue_due_timers != nullptr)
    {
        queue_due_timers(now_ns());
    }
}

// What waits in the pipe, and timers that are due, in this order; true when there were packets.
bool take_over()
{
    // No more than the pipe holds: others may send faster than the node takes over.
    CFE_SB_Buffer_t *buffer = nullptr;
    bool             came   = false;
    for (std::uint16_t left = g_node.description->pipe_depth;
         left > 0 && CFE_SB_ReceiveBuffer(&buffer, g_node.pipe, CFE_SB_POLL) == CFE_SUCCESS; --left)
    {
        dispatch(buffer);
        came = true;
    }
    queue_timers();
    return came;
}

// While this is there, the node waits.
struct Waiting
{
    Waiting() { mark(false); }
    ~Waiting() { mark(true); }
    Waiting(const Waiting &) = delete;
    Waiting &operator=(const Waiting &) = delete;

    static void mark(bool works)
    {
        if (mark_work != nullptr)
        {
            mark_work(works);
        }
    }
};

bool wait_to_the_point(std::int64_t until_ns)
{
    const Waiting waiting;
    return wait_exactly != nullptr && wait_exactly(until_ns);
}

const CFE_SB_Buffer_t *wait_for_packet(std::int32_t wait_ms)
{
    const Waiting    waiting;
    CFE_SB_Buffer_t *buffer = nullptr;
    return CFE_SB_ReceiveBuffer(&buffer, g_node.pipe, wait_ms) == CFE_SUCCESS ? buffer : nullptr;
}

bool is_threaded()
{
    return has_threads != nullptr && has_threads();
}

// Until the task that takes packets over has begun, a thread that waits does it, for a millisecond at a time.
bool wait_for_receiver(std::int64_t until_ns)
{
    let_others_run();
    if (!g_node.has_pipe || has_receiver() || (until_ns != kForever && until_ns - now_ns() < kMillisecond))
    {
        return false;
    }
    const CFE_SB_Buffer_t *packet = wait_for_packet(2); // of which the Software Bus waits for one
    if (packet != nullptr)
    {
        dispatch(packet);
    }
    queue_timers();
    return true;
}

// With threads, one of them takes packets over, and the others only wait.
bool wait_for_threads(std::int64_t until_ns)
{
    queue_timers();
    if (until_ns != kForever && now_ns() >= until_ns)
    {
        let_others_run();
        return false;
    }
    if (!has_receiver() && wait_for_receiver(until_ns))
    {
        return true;
    }
    const NextTimer timer = next_timer != nullptr ? next_timer() : NextTimer();
    const bool is_first = timer.ns != kForever && (until_ns == kForever || timer.ns < until_ns);
    wait_in_turn(is_first ? timer.ns : until_ns);
    queue_timers();
    return true;
}

// What a program waits for before it is a node; messages do not concern it.
bool wait_without_pipe(std::int64_t until_ns)
{
    const std::int64_t rest = until_ns == kForever ? kSecond : until_ns - now_ns();
    if (rest > 0 && (rest >= kMillisecond || !wait_to_the_point(until_ns)))
    {
        const std::int64_t whole = std::min<std::int64_t>(std::max(rest / kMillisecond, std::int64_t(1)), kLongestWaitMs);
        OS_TaskDelay(static_cast<std::uint32_t>(whole));
    }
    return rest > 0;
}

} // namespace

void open_bus()
{
    char pipe_name[OS_MAX_API_NAME];
    own_name(pipe_name, "_PIPE", "_P");
    if (CFE_SB_CreatePipe(&g_node.pipe, g_node.description->pipe_depth, pipe_name) != CFE_SUCCESS)
    {
        refuse("CFE_SB_CreatePipe failed", pipe_name);
    }
    g_node.has_pipe = true;
    if (open_subscribers != nullptr)
    {
        open_subscribers();
    }
    if (open_ground != nullptr)
    {
        open_ground();
    }
    if (receive_in_thread != nullptr)
    {
        receive_in_thread();
    }
}

const CFE_SB_Buffer_t *wait_in_pipe()
{
    return wait_for_packet(CFE_SB_PEND_FOREVER);
}

void take_packet(const CFE_SB_Buffer_t *buffer)
{
    dispatch(buffer);
}

bool listen(std::uint16_t msg_id)
{
    return CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(msg_id), g_node.pipe, CFE_SB_DEFAULT_QOS,
                              g_node.description->pipe_depth) == CFE_SUCCESS;
}

bool pump(std::int64_t until_ns, bool exactly)
{
    if (is_threaded())
    {
        return wait_for_threads(until_ns);
    }
    if (!g_node.has_pipe)
    {
        return wait_without_pipe(until_ns);
    }
    if (take_over())
    {
        return true;
    }
    const std::int64_t now = now_ns();
    if (until_ns != kForever && now >= until_ns)
    {
        return false;
    }
    std::int64_t    end   = until_ns;
    const NextTimer timer = next_timer != nullptr ? next_timer() : NextTimer();
    if (timer.ns != kForever && (end == kForever || timer.ns < end))
    {
        end     = timer.ns;
        exactly = timer.fast;
    }
    std::int32_t wait_ms = CFE_SB_PEND_FOREVER;
    if (end != kForever)
    {
        const std::int64_t rest = std::max<std::int64_t>(end - now, 1);
        if (exactly && rest < kMillisecond && wait_to_the_point(end))
        {
            take_over();
            return true;
        }
        // Never too early: what is due is due at the next millisecond, or exactly, after whole ones.
        const std::int64_t whole = (exactly && rest >= kMillisecond ? rest : rest + kMillisecond - 1) / kMillisecond;
        // One more, since cFE loses it: it makes the time absolute, and rounds the rest down to whole milliseconds.
        wait_ms = static_cast<std::int32_t>(std::min<std::int64_t>(whole, kLongestWaitMs)) + 1;
    }
    if (const CFE_SB_Buffer_t *buffer = wait_for_packet(wait_ms); buffer != nullptr)
    {
        dispatch(buffer);
    }
    queue_timers();
    return true;
}

void take_over_now()
{
    if (is_threaded())
    {
        let_others_run();
    }
    else if (g_node.started && !g_node.ended && !g_dispatching)
    {
        take_over();
    }
}

std::uint8_t *bytes_of(CFE_SB_Buffer_t *buffer)
{
    return reinterpret_cast<std::uint8_t *>(buffer);
}

void address_to(std::uint32_t pipe, std::uint8_t number)
{
    g_addressee = pipe & 0x00FFFFFF;
    g_number    = number;
}

CFE_SB_Buffer_t *begin_packet(std::uint16_t msg_id, std::size_t size)
{
    CFE_SB_Buffer_t *buffer = CFE_SB_AllocateMessageBuffer(size);
    if (buffer == nullptr)
    {
        ++g_counters.not_sent;
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: no memory of the Software Bus for %lu bytes on 0x%04X",
                          g_node.name.c_str(), as<unsigned long>(size), msg_id);
        return nullptr;
    }
    std::uint8_t *packet = bytes_of(buffer);
    std::memset(packet, 0, std::min(size, kTelemetryHeader));
    CFE_MSG_Init(&buffer->Msg, CFE_SB_ValueToMsgId(msg_id), size);
    if (g_addressee != 0)
    {
        packet[kSpare]     = static_cast<std::uint8_t>(g_addressee >> 16);
        packet[kSpare + 1] = static_cast<std::uint8_t>(g_addressee >> 8);
        packet[kSpare + 2] = static_cast<std::uint8_t>(g_addressee);
        packet[kSpare + 3] = static_cast<std::uint8_t>(g_number << 1 | kAddressed);
    }
    return buffer;
}

void send_packet(CFE_SB_Buffer_t *buffer)
{
    if (CFE_SB_TransmitBuffer(buffer, true) == CFE_SUCCESS)
    {
        ++g_counters.sent;
        return;
    }
    ++g_counters.not_sent;
    CFE_SB_ReleaseMessageBuffer(buffer);
}

} // namespace roscfe
