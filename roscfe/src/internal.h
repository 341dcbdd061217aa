// What the parts of the core share: the state of the one node that this shared object is.
#ifndef ROSCFE_INTERNAL_H
#define ROSCFE_INTERNAL_H

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

extern "C" {
#include "cfe.h"
#include "cfe_msgids.h"
#include "cfe_sb_msg.h"
}

#include "ros/callback_queue.h"
#include "ros/forwards.h"
#include "ros/param.h"
#include "ros/timer.h"
#include "roscfe/node.h"
#include "roscfe/publication.h"
#include "roscfe/service.h"
#include "roscfe/subscription.h"
#include "roscfe/waiting.h"

namespace roscfe
{

// Ids of the events that the library sends for its node.
enum EventId : std::uint16_t
{
    kRefusedEid   = 1,
    kStartedEid   = 2,
    kBusEid       = 3,
    kParameterEid = 4,
    kLogEid       = 5,
    kLogLostEid   = 6,
    kLossEid      = 7
};

constexpr std::size_t   kTelemetryHeader = sizeof(CFE_MSG_TelemetryHeader_t);
constexpr std::size_t   kCommandHeader   = sizeof(CFE_MSG_CommandHeader_t);
constexpr std::uint16_t kCommandBit      = 0x1000; // requests of a service are commands, its answers telemetry
constexpr std::uint16_t kMasterMsgId     = 0x08FC; // of the answers of cfepy's ROS application, as of a service
constexpr std::uint16_t kRosoutMsgId     = 0x0900;
constexpr std::size_t   kLongestKey      = 256; // characters of a parameter's name that is looked up without memory
constexpr std::size_t   kLongestMessage  = 1U << 28; // bytes that are joined from packets, where no type says how many
constexpr std::int64_t  kMillisecond     = 1000000;
constexpr std::int64_t  kSecond          = 1000000000;
constexpr std::int64_t  kForever         = -1;
constexpr std::int64_t  kFastCycle       = 10 * kMillisecond; // waits up to this are exact, later ones end at a millisecond

struct Node
{
    const NodeDescription *description = nullptr;
    std::string            name; // full
    std::string            ns;
    bool                   initialized   = false;
    bool                   started       = false;
    bool                   shutting_down = false; // it was asked to end
    bool                   is_shut       = false; // and has nothing more to do with the graph
    bool                   asked_to_end  = false; // by ES
    bool                   ended         = false; // the task is gone; objects that are destroyed now leave the bus alone
    ros::CallbackQueue     queue;
    ros::M_string          remappings; // resolved

    CFE_SB_PipeId_t  pipe{};
    bool             has_pipe = false;
    CFE_TBL_Handle_t table{};
    bool             has_table = false;
    bool             knows_subscribers = false; // the Software Bus reports subscriptions
    bool             has_master        = false; // cfepy's ROS application is there

    std::vector<boost::shared_ptr<Subscription>>   subscriptions;
    std::vector<boost::shared_ptr<Publication>>    publications;
    std::vector<boost::shared_ptr<Service>>        services;
    std::vector<boost::weak_ptr<TimerState>>       timers;
};
extern Node g_node;

// A name in OSAL that no other application has: the application's with an end, or a short end where that is too long.
void own_name(char (&name)[OS_MAX_API_NAME], const char *end, const char *short_end);

// -- bus.cpp: the node's pipe ------------------------------------------------------------------------------------------

void open_bus();

// Take over what waits in the pipe; when nothing does, wait for it until a time. Timers that are due are queued, too.
// The clock is the processor's, in nanoseconds; kForever waits without an end. False when the time is over.
// The wait ends at a millisecond of its own, or exactly; then what comes in its last millisecond is taken over at its end.
bool pump(std::int64_t until_ns, bool exactly = false);

// Wait until a time, and take the node's messages over meanwhile.
void wait_until(std::int64_t until_ns);

// Set memory aside for messages that come in several packets, or raw.
void set_aside(const Subscription &subscription);

// Take over what waits in the pipe, unless that is under way.
void take_over_now();

bool listen(std::uint16_t msg_id);

// A packet is none of its kind, since it ends early or what it says of itself cannot be; an event says so, once a kind.
enum class Ignored : std::uint8_t
{
    report,
    request,
    answer
};
void tell_ignored(Ignored what, std::uint16_t msg_id, std::size_t size);

// A packet under way: memory of the Software Bus behind a header of its own. Null when there is none, which an event says.
CFE_SB_Buffer_t *begin_packet(std::uint16_t msg_id, std::size_t size);
void             send_packet(CFE_SB_Buffer_t *buffer);
std::uint8_t *   bytes_of(CFE_SB_Buffer_t *buffer);

// Send bytes behind a header and a lead that each packet repeats, in as many packets as it takes.
void send_bytes(std::uint16_t msg_id, const std::uint8_t *lead, std::size_t lead_size, const std::uint8_t *bytes,
                std::size_t size);

// -- subscribers.cpp: who else listens ---------------------------------------------------------------------------------

void open_subscribers();
bool take_report(std::uint16_t msg_id, const CFE_SB_Buffer_t *buffer, std::size_t size);
void listen_no_more(std::uint16_t msg_id);
// The pipe has another subscription to what it hears: publishers send it the last message that they have latched.
void ask_for_repetition(std::uint16_t msg_id, std::uint8_t number);
// The node sends to a MsgId: of its subscriptions none is left out.
void send_from_now_on(std::uint16_t msg_id);
std::uint32_t pipes_on(std::uint16_t msg_id);
// The pipes that hear a MsgId, in place of what the list of subscriptions said, which tells no pipes.
void know_pipes(std::uint16_t msg_id, const std::vector<CFE_SB_PipeId_t> &pipes);

// The pipes that have subscribed to a MsgId; 0 stands for those of which only that they are there is known.
std::vector<CFE_SB_PipeId_t> those_on(std::uint16_t msg_id);
bool                         has_name(CFE_SB_PipeId_t pipe); // whether a pipe is one of this processor
bool                         hears(CFE_SB_PipeId_t pipe, std::uint16_t msg_id);
// Ask whether subscriptions without a pipe are still there, at most once a second.
void check_pipes_on(std::uint16_t msg_id);

// -- others ------------------------------------------------------------------------------------------------------------

void run_async(); // callbacks of asynchronous spinners, while the node waits
bool call_handler_of_end(); // the node's own handler of SIGINT or SIGTERM, once; false when it has none

std::int64_t now_ns();     // of the processor
std::int64_t ros_now_ns(); // of ros::Time: the same, or what /clock says
bool         is_sim_time();
void         open_clock();
void         reset_ros_timers(std::int64_t now);
void         queue_due_timers(std::int64_t now);

// The timer that is due first: kForever when none runs. A fast one is due exactly.
struct NextTimer
{
    std::int64_t ns   = kForever;
    bool         fast = false;
};
NextTimer next_timer();

// Wait until a time without taking anything over; false when OSAL has no condition variable for that (any more).
bool wait_exactly(std::int64_t until_ns);
void end_exact_waits(); // before the task ends

void publication_has_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe);
void publication_has_another(std::uint16_t msg_id, CFE_SB_PipeId_t pipe, std::uint8_t number);
void publication_lost_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe);
void clients_lost_server(std::uint16_t msg_id, CFE_SB_PipeId_t pipe);
bool take_request(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size);
bool take_answer(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size);

void open();            // the bus and the parameters, once
void open_parameters();
void reserve_keys();
void close_logging();

// What a master says of a name; of cfepy's when it is there, else of the tables that the convertor has made.
enum class Kind : std::uint8_t
{
    publisher  = 0,
    subscriber = 1,
    server     = 2,
    client     = 3,
    begun      = 0, // added to the others
    gone       = 4, // the node does not do that any more
    subscribed = 8  // the subscription is on the bus
};
struct Registration
{
    std::uint16_t msg_id  = 0;
    bool          raw     = false;
    bool          latched = false; // there are messages for a subscriber that comes now
    std::vector<CFE_SB_PipeId_t> pipes; // that hear the topic, or the service's requests
    bool          refused = false; // the master said why not; the name stays without a MsgId
};
Registration enroll(Kind kind, const std::string &name, const char *type, const char *md5, const char *definition);
void         ask_for_latched(const std::string &topic, std::uint8_t number);
constexpr std::uint8_t kTypeOfTopic = 33; // what connection_header asks

// Parameters of cfepy's ROS application, where all nodes of a mission have theirs (parameter_server.cpp). Values and names
// are as in ros/param.h.
enum class ParameterCall : std::uint8_t
{
    get       = 16,
    set       = 17,
    has       = 18,
    erase     = 19,
    search    = 20,
    names     = 21,
    give      = 22, // those of the node's table, where there are none
    watch     = 23  // as get; changes are told
};
namespace server
{
bool get(const std::string &name, XmlRpc::XmlRpcValue &value);
bool get_cached(const std::string &name, XmlRpc::XmlRpcValue &value);
void forget_cached(std::string_view name); // it has changed, or what is in it
void set(const std::string &name, const XmlRpc::XmlRpcValue &value);
void give(const XmlRpc::XmlRpcValue &tree);
bool has(const std::string &name);
bool erase(const std::string &name);
bool search(const std::string &ns, const std::string &key, std::string &result);
void names(std::vector<std::string> &found);
} // namespace server

constexpr std::uint8_t kEnded = 32; // what call_master is told by a node that ends by itself

// A call of cfepy's ROS application; false when it refuses, which an event says. What else is asked are texts.
bool call_master(std::uint8_t what, const std::string &name, const char *one, const char *two, const char *three,
                 std::vector<std::uint8_t> &answer);
void         withdraw_name(Kind kind, const std::string &name);

} // namespace roscfe

#endif
