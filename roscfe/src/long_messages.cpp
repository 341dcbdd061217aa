// Messages that have no room in a packet, or are put together elsewhere than on the bus, and raw topics, which carry whole
// packets.
#include <algorithm>
#include <cstring>

#include "internal.h"

namespace roscfe
{

namespace parts
{
extern const char long_messages = 0;
}

namespace
{

// A long message is put together here before it is cut into packets; a short one is written onto the bus itself.
std::vector<std::uint8_t> g_long_message;

// A long message that comes in several packets.
struct Assembly
{
    std::uint16_t             msg_id = 0;
    std::vector<std::uint8_t> bytes;
    std::uint16_t             next_sequence = 0;
    bool                      under_way     = false;
};
std::vector<Assembly> g_assemblies;

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

} // namespace

// -- what comes --------------------------------------------------------------------------------------------------------

void take_piece(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size, CFE_MSG_SegmentationFlag_t flag,
                int number)
{
    Assembly *whole = nullptr;
    if (comes_in_pieces(msg_id) && assemble(msg_id, packet, size, flag, whole))
    {
        give_to_subscriptions(msg_id, whole->bytes.data(), whole->bytes.size(), number);
    }
}

bool receive_raw(Subscription &subscription, const std::uint8_t *packet, std::size_t size)
{
    if (!has_room(g_raw, kRawLead + size))
    {
        ++subscription.bad_; // longer than any message of the type
        ++g_counters.bad;
        return false;
    }
    g_raw.assign(kRawLead, 0);
    for (int byte = 0; byte < 4; ++byte)
    {
        g_raw[kRawLead - 4 + static_cast<std::size_t>(byte)] = static_cast<std::uint8_t>(size >> (8 * byte));
    }
    g_raw.insert(g_raw.end(), packet, packet + size);
    return subscription.receive(g_raw.data(), g_raw.size());
}

void set_aside(const Subscription &subscription)
{
    if (subscription.raw_)
    {
        g_raw.reserve(subscription.most_bytes_);
    }
    else if (subscription.most_bytes_ > kRoom)
    {
        assembly_of(subscription.msg_id_).bytes.reserve(kTelemetryHeader + subscription.most_bytes_);
    }
}

// -- what goes out -----------------------------------------------------------------------------------------------------

void reserve_long(std::size_t most_bytes)
{
    g_long_message.reserve(most_bytes);
}

std::uint8_t *begin_long(std::size_t size)
{
    g_long_message.resize(size);
    return g_long_message.data();
}

std::uint8_t *long_message()
{
    return g_long_message.data();
}

void send_long(Publication &publication, Advertised &by, std::size_t size)
{
    const std::uint8_t *at = g_long_message.data();
    if (publication.raw_)
    {
        // std_msgs/UInt8MultiArray whose data are a whole packet, header included; it goes out as it is.
        const std::size_t lead = 12; // no dimensions, data_offset, length of the data
        if (size > lead + 6)
        {
            CFE_SB_Buffer_t *buffer = begin_packet(publication.msg_id_, size - lead);
            if (buffer != nullptr)
            {
                std::memcpy(bytes_of(buffer), at + lead, size - lead);
                send_packet(buffer);
            }
        }
        return;
    }
    if (by.latch_)
    {
        by.keep(at, size);
    }
    if (!g_node.knows_subscribers || pipes_on(publication.msg_id_) > 0)
    {
        send_bytes(publication.msg_id_, nullptr, 0, at, size);
    }
    else if (is_watched != nullptr && is_watched(publication))
    {
        std::uint8_t *shown = begin_unsent(size);
        if (shown != nullptr)
        {
            std::memcpy(shown, at, size);
            show_unsent(publication, shown, size);
        }
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

} // namespace roscfe
