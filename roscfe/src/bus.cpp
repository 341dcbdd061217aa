// The node's pipe: what comes through it, and packets that go out (CFE_SB).
#include <algorithm>
#include <cstring>

#include "internal.h"
#include "ros/single_subscriber_publisher.h"
#include "roscfe/refuse.h"

namespace roscfe
{

namespace
{

static_assert(kTelemetryHeader == 16, "topics have packets with a header of 16 bytes, as cfepy's have");

constexpr std::size_t   kSpare           = 12;   // of a telemetry header: whom a repetition is for
constexpr std::uint8_t  kAddressed       = 0x01; // in its last byte; above it stands which subscription is meant
constexpr std::int32_t  kLongestWaitMs   = 100000;

// A long message that comes in several packets.
struct Assembly
{
    std::uint16_t             msg_id = 0;
    std::vector<std::uint8_t> bytes;
    std::uint16_t             next_sequence = 0;
    bool                      under_way     = false;
};
std::vector<Assembly> g_assemblies;

std::uint32_t pipe_number(CFE_SB_PipeId_t pipe)
{
    return static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe)) & 0x00FFFFFF;
}

constexpr std::size_t     kRawLead = 12; // of std_msgs/UInt8MultiArray: no dimensions, no offset, the length of the data
std::vector<std::uint8_t> g_raw;         // the message of a raw packet

// Whether more bytes are taken; memory that was set aside in the profile strict does not grow.
bool has_room(const std::vector<std::uint8_t> &in, std::size_t size)
{
#if defined(ROSCFE_PROFILE_STRICT)
    return size <= in.capacity();
#else
    (void)in;
    return size <= kLongestMessage;
#endif
}

// Whether messages of a topic may come in several packets. Where they have a size at most, `set_aside` knows; in the
// profile strict no others are taken, since joining them takes memory.
bool comes_in_pieces(std::uint16_t msg_id)
{
    const auto found = std::find_if(g_assemblies.begin(), g_assemblies.end(),
                                    [&](const Assembly &each) { return each.msg_id == msg_id; });
#if defined(ROSCFE_PROFILE_STRICT)
    return found != g_assemblies.end();
#else
    bool known = true;
    for (const boost::shared_ptr<Subscription> &each : g_node.subscriptions)
    {
        known = known && (each->msg_id_ != msg_id || each->most_bytes_ > 0);
    }
    return !known || found != g_assemblies.end();
#endif
}

Assembly &assembly_of(std::uint16_t msg_id)
{
    for (Assembly &each : g_assemblies)
    {
        if (each.msg_id == msg_id)
        {
            return each;
        }
    }
    g_assemblies.emplace_back();
    g_assemblies.back().msg_id = msg_id;
    return g_assemblies.back();
}

// Join a segment to its message; true when that is whole, and the first bytes are those of its first packet's header.
bool assemble(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size, CFE_MSG_SegmentationFlag_t flag,
              Assembly *&whole)
{
    const auto sequence = static_cast<std::uint16_t>((packet[2] & 0x3F) << 8 | packet[3]);
    Assembly & found    = assembly_of(msg_id);
    if (flag == CFE_MSG_SegFlag_First && has_room(found.bytes, size))
    {
        found.bytes.assign(packet, packet + size);
        found.under_way = true;
    }
    else if (flag != CFE_MSG_SegFlag_First && found.under_way && sequence == found.next_sequence &&
             has_room(found.bytes, found.bytes.size() + size - kTelemetryHeader))
    {
        found.bytes.insert(found.bytes.end(), packet + kTelemetryHeader, packet + size);
    }
    else
    {
        found.under_way = false;
        return false;
    }
    found.next_sequence = (sequence + 1) & 0x3FFF;
    whole               = &found;
    found.under_way     = flag != CFE_MSG_SegFlag_Last;
    return flag == CFE_MSG_SegFlag_Last;
}

constexpr int kAll = -1; // subscriptions of a topic

// What is not for all is a repetition for the subscription with a number.
void give_to_subscriptions(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size, int number)
{
    for (std::size_t i = 0; i < g_node.subscriptions.size(); ++i)
    {
        const boost::shared_ptr<Subscription> &each = g_node.subscriptions[i];
        if (each->msg_id_ != msg_id || !each->alive_ || (number != kAll && number != each->number_))
        {
            continue;
        }
        const std::uint32_t bad  = each->bad_;
        bool                more = false;
        if (each->raw_ && !has_room(g_raw, kRawLead + size))
        {
            ++each->bad_; // longer than any message of the type
        }
        else if (each->raw_)
        {
            g_raw.assign(kRawLead, 0);
            for (int byte = 0; byte < 4; ++byte)
            {
                g_raw[kRawLead - 4 + static_cast<std::size_t>(byte)] = static_cast<std::uint8_t>(size >> (8 * byte));
            }
            g_raw.insert(g_raw.end(), packet, packet + size);
            more = each->receive(g_raw.data(), g_raw.size());
        }
        else if (size >= kTelemetryHeader)
        {
            more = each->receive(packet + kTelemetryHeader, size - kTelemetryHeader);
        }
        if (each->bad_ != bad && bad == 0)
        {
            CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR,
                              "%s: refused %lu bytes on %s: no message of its type, or one beyond its capacities; told once",
                              g_node.name.c_str(), static_cast<unsigned long>(size), each->topic_.c_str());
        }
        if (more)
        {
            each->callbacks_->addCallback(each, reinterpret_cast<std::uintptr_t>(each.get()));
        }
    }
}

bool g_dispatching = false;

// While one packet is given to whom it is for, no other is taken over.
struct Dispatching
{
    Dispatching() : outer(g_dispatching) { g_dispatching = true; }
    ~Dispatching() { g_dispatching = outer; }
    Dispatching(const Dispatching &) = delete;
    Dispatching &operator=(const Dispatching &) = delete;

    const bool outer;
};

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
    if (take_report(msg_id, buffer, size) || take_request(msg_id, packet, size) ||
        take_answer(msg_id, packet, size))
    {
        return;
    }
    int number = kAll;
    if (size >= kTelemetryHeader && (packet[kSpare + 3] & kAddressed) != 0)
    {
        number = packet[kSpare + 3] >> 1;
        const std::uint32_t whom = static_cast<std::uint32_t>(packet[kSpare]) << 16 |
                                   static_cast<std::uint32_t>(packet[kSpare + 1]) << 8 | packet[kSpare + 2];
        if (whom != pipe_number(g_node.pipe))
        {
            return;
        }
    }
    Assembly *whole = nullptr;
    if (flag == CFE_MSG_SegFlag_Unsegmented)
    {
        give_to_subscriptions(msg_id, packet, size, number);
    }
    else if (size >= kTelemetryHeader && comes_in_pieces(msg_id) && assemble(msg_id, packet, size, flag, whole))
    {
        give_to_subscriptions(msg_id, whole->bytes.data(), whole->bytes.size(), number);
    }
}

void address(std::uint8_t *packet, std::uint32_t pipe, std::uint8_t number)
{
    packet[kSpare]     = static_cast<std::uint8_t>(pipe >> 16);
    packet[kSpare + 1] = static_cast<std::uint8_t>(pipe >> 8);
    packet[kSpare + 2] = static_cast<std::uint8_t>(pipe);
    packet[kSpare + 3] = static_cast<std::uint8_t>(number << 1 | kAddressed);
}

// What waits in the pipe, and timers that are due, in this order; true when there were packets.
bool take_over()
{
    CFE_SB_Buffer_t *buffer = nullptr;
    bool             came   = false;
    while (CFE_SB_ReceiveBuffer(&buffer, g_node.pipe, CFE_SB_POLL) == CFE_SUCCESS)
    {
        dispatch(buffer);
        came = true;
    }
    queue_due_timers(now_ns());
    return came;
}

std::uint32_t g_addressee = 0; // of what is sent at the moment; 0 is everybody
std::uint8_t  g_number    = 0; // of its subscription

} // namespace

void open_bus()
{
    char pipe_name[OS_MAX_API_NAME];
    own_name(pipe_name, "_PIPE", "_P");
    const CFE_Status_t status = CFE_SB_CreatePipe(&g_node.pipe, g_node.description->pipe_depth, pipe_name);
    if (status != CFE_SUCCESS)
    {
        refuse("CFE_SB_CreatePipe failed", pipe_name);
    }
    g_node.has_pipe = true;
    open_subscribers();
}

void set_aside(const Subscription &subscription)
{
    if (subscription.raw_)
    {
        g_raw.reserve(subscription.most_bytes_);
    }
    else if (subscription.most_bytes_ > CFE_MISSION_SB_MAX_SB_MSG_SIZE - kTelemetryHeader)
    {
        assembly_of(subscription.msg_id_).bytes.reserve(kTelemetryHeader + subscription.most_bytes_);
    }
}

void tell_ignored(Ignored what, std::uint16_t msg_id, std::size_t size)
{
    static const char *const kWhat[] = {"report of subscriptions", "request of a service", "answer of a service"};
    static bool              is_told[sizeof kWhat / sizeof *kWhat];
    const auto               number = static_cast<std::size_t>(what);
    if (!is_told[number])
    {
        is_told[number] = true;
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: ignored %lu bytes on 0x%04X: no %s; told once",
                          g_node.name.c_str(), static_cast<unsigned long>(size), msg_id, kWhat[number]);
    }
}

bool listen(std::uint16_t msg_id)
{
    return CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(msg_id), g_node.pipe, CFE_SB_DEFAULT_QOS,
                              g_node.description->pipe_depth) == CFE_SUCCESS;
}

namespace
{

// What a program waits for before it is a node; messages do not concern it.
bool wait_without_pipe(std::int64_t until_ns)
{
    const std::int64_t rest = until_ns == kForever ? kSecond : until_ns - now_ns();
    if (rest > 0 && (rest >= kMillisecond || !wait_exactly(until_ns)))
    {
        const std::int64_t whole = std::min<std::int64_t>(std::max(rest / kMillisecond, std::int64_t(1)), kLongestWaitMs);
        OS_TaskDelay(static_cast<std::uint32_t>(whole));
    }
    return rest > 0;
}

} // namespace

bool pump(std::int64_t until_ns, bool exactly)
{
    if (!g_node.has_pipe)
    {
        return wait_without_pipe(until_ns);
    }
    const bool came = take_over();
    if (came)
    {
        return true;
    }
    const std::int64_t now = now_ns();
    if (until_ns != kForever && now >= until_ns)
    {
        return false;
    }
    std::int64_t    end   = until_ns;
    const NextTimer timer = next_timer();
    if (timer.ns != kForever && (end == kForever || timer.ns < end))
    {
        end     = timer.ns;
        exactly = timer.fast;
    }
    std::int32_t wait_ms = CFE_SB_PEND_FOREVER;
    if (end != kForever)
    {
        const std::int64_t rest = std::max<std::int64_t>(end - now, 1);
        if (exactly && rest < kMillisecond && wait_exactly(end))
        {
            take_over();
            return true;
        }
        // Never too early: what is due is due at the next millisecond, or exactly, after whole ones.
        const std::int64_t whole = (exactly && rest >= kMillisecond ? rest : rest + kMillisecond - 1) / kMillisecond;
        // One more, since cFE loses it: it makes the time absolute, and rounds the rest down to whole milliseconds.
        wait_ms = static_cast<std::int32_t>(std::min<std::int64_t>(whole, kLongestWaitMs)) + 1;
    }
    CFE_SB_Buffer_t *buffer = nullptr;
    if (CFE_SB_ReceiveBuffer(&buffer, g_node.pipe, wait_ms) == CFE_SUCCESS)
    {
        dispatch(buffer);
    }
    queue_due_timers(now_ns());
    return true;
}

void take_over_now()
{
    if (g_node.started && !g_node.ended && !g_dispatching)
    {
        take_over();
    }
}

void wait_until(std::int64_t until_ns)
{
    const bool exactly = until_ns - now_ns() <= kFastCycle;
    while (now_ns() < until_ns && pump(until_ns, exactly))
    {
        run_async();
    }
}

std::uint8_t *bytes_of(CFE_SB_Buffer_t *buffer)
{
    return reinterpret_cast<std::uint8_t *>(buffer);
}

CFE_SB_Buffer_t *begin_packet(std::uint16_t msg_id, std::size_t size)
{
    CFE_SB_Buffer_t *buffer = CFE_SB_AllocateMessageBuffer(size);
    if (buffer == nullptr)
    {
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: no memory of the Software Bus for %lu bytes on 0x%04X",
                          g_node.name.c_str(), static_cast<unsigned long>(size), msg_id);
        return nullptr;
    }
    std::memset(bytes_of(buffer), 0, std::min(size, kTelemetryHeader));
    CFE_MSG_Init(&buffer->Msg, CFE_SB_ValueToMsgId(msg_id), size);
    if (g_addressee != 0)
    {
        address(bytes_of(buffer), g_addressee, g_number);
    }
    return buffer;
}

void send_packet(CFE_SB_Buffer_t *buffer)
{
    if (CFE_SB_TransmitBuffer(buffer, true) != CFE_SUCCESS)
    {
        CFE_SB_ReleaseMessageBuffer(buffer);
    }
}

void send_bytes(std::uint16_t msg_id, const std::uint8_t *lead, std::size_t lead_size, const std::uint8_t *bytes,
                std::size_t size)
{
    const std::size_t header = (msg_id & kCommandBit) != 0 ? kCommandHeader : kTelemetryHeader;
    const std::size_t room   = CFE_MISSION_SB_MAX_SB_MSG_SIZE - header - lead_size;
    std::size_t       at     = 0;
    do
    {
        const std::size_t part   = std::min(room, size - at);
        CFE_SB_Buffer_t * buffer = begin_packet(msg_id, header + lead_size + part);
        if (buffer == nullptr)
        {
            return;
        }
        if (size > room)
        {
            CFE_MSG_SetSegmentationFlag(&buffer->Msg, at == 0             ? CFE_MSG_SegFlag_First
                                                      : at + part >= size ? CFE_MSG_SegFlag_Last
                                                                          : CFE_MSG_SegFlag_Continue);
        }
        if (lead_size > 0)
        {
            std::memcpy(bytes_of(buffer) + header, lead, lead_size);
        }
        if (part > 0)
        {
            std::memcpy(bytes_of(buffer) + header + lead_size, bytes + at, part);
        }
        send_packet(buffer);
        at += part;
    } while (at < size);
}

void send_to(Publication &publication, std::uint32_t pipe, const std::uint8_t *bytes, std::size_t size,
             std::uint8_t number)
{
    g_addressee = pipe & 0x00FFFFFF;
    g_number    = number;
    send_bytes(publication.msg_id_, nullptr, 0, bytes, size);
    g_addressee = 0;
    g_number    = 0;
}

} // namespace roscfe
