// Who else listens on the processor: subscriptions, as the Software Bus reports them (CFE_SB_SUB_RPT_CTRL).
#include <algorithm>
#include <cstddef>

#include "internal.h"
#include "roscfe/heap.h"
#include "roscfe/parts.h"

namespace roscfe
{

namespace parts
{
extern const char subscribers = 0;
}

namespace
{

constexpr std::size_t   kMostKnown     = 512; // subscriptions that are kept, of the whole processor
#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)
constexpr std::size_t   kKnownAtOnce   = 64;  // before memory is needed for more, which there is until the node spins
#else
constexpr std::size_t   kKnownAtOnce   = kMostKnown;
#endif
constexpr std::size_t   kOwnAtOnce     = 64;  // MsgIds that the node sends to, before memory is needed for more
constexpr std::int64_t  kReportTimeout = kSecond;
constexpr unsigned long kOutside       = 0xFF000000UL; // ids from here on are of subscribers outside of the processor

// A subscription of any application: with its pipe when it is new. The list of those that there were before tells no pipes
// (0), and a MsgId once however many pipes have subscribed to it.
struct Known
{
    std::uint16_t   msg_id;
    bool            is_listed; // in the list that is under way
    CFE_SB_PipeId_t pipe;
    osal_id_t       queue; // of the pipe; OSAL tells whether it is there without an event
};
std::vector<Known>         g_known;
std::vector<std::uint16_t> g_own;           // MsgIds that the node sends to: room is made for their subscriptions
bool                       g_left_out = false; // there was no room for others

// The list of subscriptions, which comes in several packets.
bool          g_list_came    = false; // its last packet came, once
std::uint16_t g_list_begins  = 0;     // its first MsgId
std::uint32_t g_next_segment = 0;     // the packet that is to come; 0 when one was lost
bool          g_is_checking  = false; // what is not in the next list is gone
std::int64_t  g_checked_ns   = INT64_MIN / 2;

const CFE_SB_PipeId_t kNoPipe = CFE_SB_INVALID_PIPE;

bool same_pipe(CFE_SB_PipeId_t one, CFE_SB_PipeId_t other)
{
    return CFE_RESOURCEID_TO_ULONG(one) == CFE_RESOURCEID_TO_ULONG(other);
}

bool is_outside(CFE_SB_PipeId_t pipe)
{
    return CFE_RESOURCEID_TO_ULONG(pipe) >= kOutside;
}

bool is_there(const Known &known)
{
    if (!has_name(known.pipe))
    {
        return true; // nobody can say, and the end of a subscriber outside is told
    }
    if (!OS_ObjectIdDefined(known.queue)) // pipes are no queues of OSAL here, as on cfepy
    {
        char name[OS_MAX_API_NAME];
        return CFE_SB_GetPipeName(name, sizeof name, known.pipe) == CFE_SUCCESS;
    }
    OS_queue_prop_t properties;
    return OS_QueueGetInfo(known.queue, &properties) == OS_SUCCESS;
}

bool is_own(std::uint16_t msg_id)
{
    return std::find(g_own.begin(), g_own.end(), msg_id) != g_own.end();
}

std::size_t room_for_known()
{
    return heap::is_sealed() && kKnownAtOnce < kMostKnown ? std::min(g_known.capacity(), kMostKnown) : kMostKnown;
}

// Whether there is room for one more subscription. For one that concerns the node, one that does not is left out.
bool has_room_for(std::uint16_t msg_id)
{
    if (g_known.size() < room_for_known())
    {
        return true;
    }
    if (!g_left_out)
    {
        g_left_out = true;
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_INFORMATION, "%s: more than %lu subscriptions; others are left out",
                          g_node.name.c_str(), as<unsigned long>(g_known.size()));
    }
    const auto other = std::find_if(g_known.begin(), g_known.end(),
                                    [](const Known &known) { return !is_own(known.msg_id); });
    if (!is_own(msg_id) || other == g_known.end())
    {
        return false;
    }
    g_known.erase(other);
    return true;
}

void know(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    for (const Known &known : g_known)
    {
        if (known.msg_id == msg_id && same_pipe(known.pipe, pipe))
        {
            return;
        }
    }
    char      name[OS_MAX_API_NAME];
    osal_id_t queue = OS_OBJECT_ID_UNDEFINED;
    if (!is_outside(pipe))
    {
        if (CFE_SB_GetPipeName(name, sizeof name, pipe) != CFE_SUCCESS)
        {
            return; // gone already
        }
        if (OS_QueueGetIdByName(&queue, name) != OS_SUCCESS)
        {
            queue = OS_OBJECT_ID_UNDEFINED;
        }
    }
    if (has_room_for(msg_id))
    {
        g_known.push_back({msg_id, false, pipe, queue});
        if (publication_has_subscriber != nullptr)
        {
            publication_has_subscriber(msg_id, pipe);
        }
    }
}

void forget(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    g_known.erase(std::remove_if(g_known.begin(), g_known.end(),
                                 [&](const Known &known) {
                                     return known.msg_id == msg_id && same_pipe(known.pipe, pipe);
                                 }),
                  g_known.end());
    if (publication_lost_subscriber != nullptr)
    {
        publication_lost_subscriber(msg_id, pipe);
    }
    if (clients_lost_server != nullptr)
    {
        clients_lost_server(msg_id, pipe);
    }
}

void forget_all_without_pipe(std::uint16_t msg_id)
{
    g_known.erase(std::remove_if(g_known.begin(), g_known.end(),
                                 [&](const Known &known) {
                                     return known.msg_id == msg_id && same_pipe(known.pipe, kNoPipe);
                                 }),
                  g_known.end());
}

// -- reports -----------------------------------------------------------------------------------------------------------

// The MsgId in a report; 0 for one that no topic or service has.
std::uint16_t msg_id_of(CFE_SB_MsgId_t told)
{
    const auto value = CFE_SB_MsgIdToValue(told);
    return value <= 0xFFFF ? static_cast<std::uint16_t>(value) : std::uint16_t(0);
}

// A subscription that was just made, or has ended.
bool read_one(const CFE_SB_Buffer_t *buffer, std::size_t size)
{
    typedef CFE_SB_SingleSubscriptionTlm_t Packet;
    if (size < offsetof(Packet, Payload.Pipe) + sizeof(CFE_SB_PipeId_t))
    {
        return false;
    }
    const auto &        report = reinterpret_cast<const Packet *>(buffer)->Payload;
    const std::uint16_t id     = msg_id_of(report.MsgId);
    if (id == 0)
    {
        return true;
    }
    if (report.SubType != CFE_SB_SUBSCRIPTION)
    {
        forget(id, report.Pipe);
    }
    else if (report.Qos.Priority == 0)
    {
        know(id, report.Pipe);
    }
    else if (!same_pipe(report.Pipe, g_node.pipe) && publication_has_another != nullptr)
    {
        publication_has_another(id, report.Pipe, report.Qos.Priority);
    }
    return true;
}

// The list is whole: what it should have and has not is gone.
void end_list()
{
    g_next_segment = 0;
    if (!g_is_checking)
    {
        return;
    }
    g_is_checking = false;
    for (std::size_t i = g_known.size(); i > 0; --i)
    {
        const Known known = g_known[i - 1];
        if (same_pipe(known.pipe, kNoPipe) && !known.is_listed)
        {
            forget(known.msg_id, kNoPipe);
        }
    }
}

void list(std::uint16_t msg_id)
{
    bool is_known = false;
    for (Known &known : g_known)
    {
        if (known.msg_id == msg_id)
        {
            known.is_listed = true;
            is_known        = true;
        }
    }
    // Other nodes ask for the list, too; it tells nothing of a MsgId that is known already.
    if (!is_known && has_room_for(msg_id))
    {
        g_known.push_back({msg_id, true, kNoPipe, OS_OBJECT_ID_UNDEFINED});
    }
}

// A packet of the list of subscriptions.
bool read_list(const CFE_SB_Buffer_t *buffer, std::size_t size)
{
    typedef CFE_SB_AllSubscriptionsTlm_t Packet;
    constexpr std::size_t                kLead  = offsetof(Packet, Payload.Entry);
    const auto &                         report = reinterpret_cast<const Packet *>(buffer)->Payload;
    if (size < kLead || report.Entries > CFE_MISSION_SB_SUB_ENTRIES_PER_PKT ||
        size - kLead < report.Entries * sizeof report.Entry[0])
    {
        return false;
    }
    if (report.PktSegment == 1)
    {
        if (g_next_segment > 1)
        {
            end_list(); // the last packet of the list before had no room, either
        }
        for (Known &known : g_known)
        {
            known.is_listed = false;
        }
        g_next_segment = 1;
    }
    for (std::uint32_t i = 0; i < report.Entries; ++i)
    {
        const std::uint16_t id = msg_id_of(report.Entry[i].MsgId);
        if (id != 0)
        {
            list(id);
        }
    }
    // A packet with room is the last one. A full one may be: the list that begins anew says so.
    const bool          is_last = report.Entries < CFE_MISSION_SB_SUB_ENTRIES_PER_PKT;
    const std::uint16_t first   = report.Entries > 0 ? msg_id_of(report.Entry[0].MsgId) : std::uint16_t(0);
    g_list_came                 = g_list_came || is_last || first == g_list_begins;
    g_list_begins               = g_list_begins != 0 ? g_list_begins : first;
    g_next_segment              = g_next_segment != 0 && report.PktSegment == g_next_segment ? g_next_segment + 1 : 0;
    if (is_last && g_next_segment != 0)
    {
        end_list();
    }
    return true;
}

// A report as the Software Bus makes one when a pipe subscribes.
void report(std::uint16_t msg_id, std::uint8_t kind, std::uint8_t number)
{
    CFE_SB_Buffer_t *buffer = CFE_SB_AllocateMessageBuffer(sizeof(CFE_SB_SingleSubscriptionTlm_t));
    if (buffer != nullptr)
    {
        CFE_MSG_Init(&buffer->Msg, CFE_SB_ValueToMsgId(CFE_SB_ONESUB_TLM_MID), sizeof(CFE_SB_SingleSubscriptionTlm_t));
        auto &told           = reinterpret_cast<CFE_SB_SingleSubscriptionTlm_t *>(buffer)->Payload;
        told.SubType         = kind;
        told.MsgId           = CFE_SB_ValueToMsgId(msg_id);
        told.Qos.Priority    = number;
        told.Qos.Reliability = 0;
        told.Pipe            = g_node.pipe;
        send_packet(buffer);
    }
}

void ask_for_reports(CFE_MSG_FcnCode_t code)
{
    CFE_SB_Buffer_t *buffer = CFE_SB_AllocateMessageBuffer(kCommandHeader);
    if (buffer != nullptr)
    {
        CFE_MSG_Init(&buffer->Msg, CFE_SB_ValueToMsgId(CFE_SB_SUB_RPT_CTRL_MID), kCommandHeader);
        CFE_MSG_SetFcnCode(&buffer->Msg, code);
        send_packet(buffer);
    }
}

} // namespace

void open_subscribers()
{
    g_known.reserve(kKnownAtOnce);
    g_own.reserve(kOwnAtOnce);
    send_from_now_on(kMasterMsgId | kCommandBit);
    send_from_now_on(kRosoutMsgId);
    // As SBN does it: the Software Bus tells who subscribes, and who has. Without, every message is sent.
    if (!listen(CFE_SB_ONESUB_TLM_MID) || !listen(CFE_SB_ALLSUBS_TLM_MID))
    {
        return;
    }
    // In this order no subscription is missed: what is not in the list comes after it, and is reported.
    ask_for_reports(CFE_SB_ENABLE_SUB_REPORTING_CC);
    ask_for_reports(CFE_SB_SEND_PREV_SUBS_CC);
    bool               again = false;
    const std::int64_t until = now_ns() + kReportTimeout;
    while (!g_list_came && pump(until))
    {
        if (g_list_begins != 0 && !g_list_came && !again)
        {
            again = true;
            ask_for_reports(CFE_SB_SEND_PREV_SUBS_CC);
        }
    }
    g_node.knows_subscribers = !g_known.empty();
    g_node.has_master        = enroll_with_master != nullptr && pipes_on(kMasterMsgId | kCommandBit) > 0;
}

bool take_report(std::uint16_t msg_id, const CFE_SB_Buffer_t *buffer, std::size_t size)
{
    if (msg_id != CFE_SB_ONESUB_TLM_MID && msg_id != CFE_SB_ALLSUBS_TLM_MID)
    {
        return false;
    }
    if (!(msg_id == CFE_SB_ONESUB_TLM_MID ? read_one(buffer, size) : read_list(buffer, size)))
    {
        tell_ignored(Ignored::report, msg_id, size);
    }
    return true;
}

void send_from_now_on(std::uint16_t msg_id)
{
    if (!is_own(msg_id))
    {
        g_own.push_back(msg_id);
        if (g_left_out)
        {
            ask_for_reports(CFE_SB_SEND_PREV_SUBS_CC); // its subscriptions may be among those
        }
    }
}

void listen_no_more(std::uint16_t msg_id)
{
    if (!g_node.knows_subscribers)
    {
        return;
    }
    // The Software Bus reports no subscription that ends; publishers are to know all the same.
    report(msg_id, CFE_SB_UNSUBSCRIPTION, 0);
}

void ask_for_repetition(std::uint16_t msg_id, std::uint8_t number)
{
    if (g_node.knows_subscribers)
    {
        report(msg_id, CFE_SB_SUBSCRIPTION, number);
    }
}

void know_pipes(std::uint16_t msg_id, const std::vector<CFE_SB_PipeId_t> &pipes)
{
    forget_all_without_pipe(msg_id);
    for (const CFE_SB_PipeId_t &pipe : pipes)
    {
        know(msg_id, pipe);
    }
}

std::uint32_t pipes_on(std::uint16_t msg_id)
{
    std::uint32_t count = 0;
    for (std::size_t i = g_known.size(); i > 0; --i)
    {
        const Known known = g_known[i - 1];
        if (known.msg_id != msg_id)
        {
            continue;
        }
        if (is_there(known))
        {
            ++count;
        }
        else
        {
            forget(msg_id, known.pipe); // its application has ended
        }
    }
    return count;
}

std::vector<CFE_SB_PipeId_t> those_on(std::uint16_t msg_id)
{
    std::vector<CFE_SB_PipeId_t> found;
    for (const Known &known : g_known)
    {
        if (known.msg_id == msg_id && is_there(known))
        {
            found.push_back(known.pipe);
        }
    }
    return found;
}

bool has_name(CFE_SB_PipeId_t pipe)
{
    return !same_pipe(pipe, kNoPipe) && !is_outside(pipe);
}

bool hears(CFE_SB_PipeId_t pipe, std::uint16_t msg_id)
{
    return std::any_of(g_known.begin(), g_known.end(), [&](const Known &known) {
        return known.msg_id == msg_id && same_pipe(known.pipe, pipe) && is_there(known);
    });
}

void check_pipes_on(std::uint16_t msg_id)
{
    if (!g_node.knows_subscribers || !hears(kNoPipe, msg_id) || now_ns() - g_checked_ns < kReportTimeout)
    {
        return;
    }
    g_checked_ns   = now_ns();
    g_is_checking  = true;
    g_next_segment = 0;
    ask_for_reports(CFE_SB_SEND_PREV_SUBS_CC);
    take_over_now(); // the Software Bus goes first, and has answered
}

} // namespace roscfe
