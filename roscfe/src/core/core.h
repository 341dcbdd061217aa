// The core: publish, subscribe, spin and the time. It is complete without the other sources; what they add to it, it calls
// through hooks, which are null in an image that leaves them out.
#ifndef ROSCFE_CORE_H
#define ROSCFE_CORE_H

#include <cstdint>
#include <string>
#include <vector>

extern "C" {
#include "cfe.h"
}

#include "ros/callback_queue.h"
#include "ros/forwards.h"
#include "roscfe/node.h"
#include "roscfe/publication.h"
#include "roscfe/subscription.h"

// A function that may be missing: compare it with a null pointer before the call.
#define ROSCFE_HOOK __attribute__((weak, visibility("hidden")))

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
    kLossEid      = 7,
    kMemoryEid    = 8,
    kCommandEid   = 9,
    kWaitEid      = 10
};

constexpr std::size_t   kTelemetryHeader = sizeof(CFE_MSG_TelemetryHeader_t);
constexpr std::size_t   kCommandHeader   = sizeof(CFE_MSG_CommandHeader_t);
constexpr std::size_t   kRoom            = CFE_MISSION_SB_MAX_SB_MSG_SIZE - kTelemetryHeader; // of a message in one packet
constexpr std::uint16_t kRosoutMsgId     = 0x0900;
constexpr std::int64_t  kMillisecond     = 1000000;
constexpr std::int64_t  kSecond          = 1000000000;
constexpr std::int64_t  kForever         = -1;
constexpr std::int64_t  kFastCycle       = 10 * kMillisecond; // waits up to this are exact, later ones end at a millisecond

// A conversion between integers. On some processors it is one of a type to itself, as of size_t to unsigned long.
template <class To, class From>
constexpr To as(From value)
{
    return static_cast<To>(value);
}

class Service;
class TimerState;

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
    bool             has_table         = false;
    bool             knows_subscribers = false; // the Software Bus reports subscriptions
    bool             has_master        = false; // cfepy's ROS application is there

    std::vector<boost::shared_ptr<Subscription>> subscriptions;
    std::vector<boost::shared_ptr<Publication>>  publications;
    std::vector<boost::shared_ptr<Service>>      services;
    std::vector<boost::weak_ptr<TimerState>>     timers;
};
extern Node g_node;

// A name in OSAL that no other application has: the application's with an end, or a short end where that is too long.
void own_name(char (&name)[OS_MAX_API_NAME], const char *end, const char *short_end);
void open(); // the bus and the parameters, once
[[noreturn]] void end(int exit_status);
void initialize(const std::string &name, std::uint32_t options);
void remap(const std::string &from, const std::string &to);

// -- the node's pipe ---------------------------------------------------------------------------------------------------

void open_bus();

// Take over what waits in the pipe; when nothing does, wait for it until a time. Timers that are due are queued, too.
// The clock is the processor's, in nanoseconds; kForever waits without an end. False when the time is over.
// The wait ends at a millisecond of its own, or exactly; then what comes in its last millisecond is taken over at its end.
bool pump(std::int64_t until_ns, bool exactly = false);

// Wait until a time, and take the node's messages over meanwhile.
void wait_until(std::int64_t until_ns);

// Take over what waits in the pipe, unless that is under way.
void take_over_now();

// For a thread that does nothing else: wait for a packet, which is null when there is no pipe any more, and take it over.
const CFE_SB_Buffer_t *wait_in_pipe();
void                   take_packet(const CFE_SB_Buffer_t *buffer);

bool listen(std::uint16_t msg_id);

// A packet under way: memory of the Software Bus behind a header of its own. Null when there is none, which an event says.
CFE_SB_Buffer_t *begin_packet(std::uint16_t msg_id, std::size_t size);
void             send_packet(CFE_SB_Buffer_t *buffer);
std::uint8_t *   bytes_of(CFE_SB_Buffer_t *buffer);

// Whom the packets are for that are begun now: 0 is everybody, else a pipe's subscription with a number.
void address_to(std::uint32_t pipe, std::uint8_t number);

// A whole message for the subscriptions of a topic: for all of them, or the one with a number.
constexpr int kAll = -1;
void give_to_subscriptions(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size, int number);

// -- time and names ----------------------------------------------------------------------------------------------------

std::int64_t now_ns();     // of the processor
std::int64_t ros_now_ns(); // of ros::Time: the same, or what /clock says
bool         is_simulated(); // whether /clock does

// The place of a topic on the bus.
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
Registration enroll_topic(Kind kind, const std::string &name, const char *type, const char *md5, const char *definition);

// -- hooks: what an image may leave out --------------------------------------------------------------------------------

// subscribers.cpp: who listens. Without it every message is sent.
ROSCFE_HOOK void          open_subscribers();
ROSCFE_HOOK bool          take_report(std::uint16_t msg_id, const CFE_SB_Buffer_t *buffer, std::size_t size);
ROSCFE_HOOK void          send_from_now_on(std::uint16_t msg_id);
ROSCFE_HOOK std::uint32_t pipes_on(std::uint16_t msg_id);
ROSCFE_HOOK void          know_pipes(std::uint16_t msg_id, const std::vector<CFE_SB_PipeId_t> &pipes);
ROSCFE_HOOK void          listen_no_more(std::uint16_t msg_id);

// latching.cpp: messages for subscribers that come later, and callbacks that are told of subscribers.
ROSCFE_HOOK boost::shared_ptr<Advertised> make_advertised(const boost::shared_ptr<Publication> &publication,
                                                          const ros::AdvertiseOptions &         options,
                                                          ros::CallbackQueueInterface *         callbacks);
ROSCFE_HOOK void another_subscription(const boost::shared_ptr<Subscription> &subscription);

// long_messages.cpp: those that have no room in a packet, and raw topics.
ROSCFE_HOOK void          reserve_long(std::size_t most_bytes);
ROSCFE_HOOK std::uint8_t *begin_long(std::size_t size);
ROSCFE_HOOK std::uint8_t *long_message();
ROSCFE_HOOK void          send_long(Publication &publication, Advertised &by, std::size_t size);
ROSCFE_HOOK void          set_aside(const Subscription &subscription);
ROSCFE_HOOK void take_piece(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size,
                            CFE_MSG_SegmentationFlag_t flag, int number);
ROSCFE_HOOK bool receive_raw(Subscription &subscription, const std::uint8_t *packet, std::size_t size);

// ground.cpp: commands of the ground, and marks in the performance log when the node begins to work, or to wait.
ROSCFE_HOOK void open_ground();
ROSCFE_HOOK bool take_command(std::uint16_t msg_id, const CFE_SB_Buffer_t *buffer, std::size_t size);
ROSCFE_HOOK void mark_work(bool begins);

// turns.cpp: threads of the node, one of which runs at a time.
ROSCFE_HOOK bool has_threads();                       // there are others than the main thread
ROSCFE_HOOK bool has_receiver();                      // one of them takes packets over
ROSCFE_HOOK void wait_in_turn(std::int64_t until_ns); // others run until something changes, or a time
ROSCFE_HOOK void let_others_run();                    // those that want to
ROSCFE_HOOK void receive_in_thread();                 // from now on, if there are threads

// services.cpp, timers.cpp, exact_waits.cpp, async.cpp, sim_time.cpp, parameters.cpp, private_parameters.cpp, master.cpp
// and logging.cpp.
ROSCFE_HOOK bool take_request(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size);
ROSCFE_HOOK bool take_answer(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size);
ROSCFE_HOOK void queue_due_timers(std::int64_t now);
struct NextTimer
{
    std::int64_t ns   = kForever; // when none runs
    bool         fast = false;    // it is due exactly
};
ROSCFE_HOOK NextTimer    next_timer();
ROSCFE_HOOK bool         wait_exactly(std::int64_t until_ns); // without taking anything over; false when OSAL cannot
ROSCFE_HOOK void         end_exact_waits();                   // before the task ends
ROSCFE_HOOK void         run_async(); // callbacks of asynchronous spinners, while the node waits
ROSCFE_HOOK bool         is_sim_time();
ROSCFE_HOOK std::int64_t sim_time_ns();
ROSCFE_HOOK bool         wait_for_clock(std::int64_t length);
ROSCFE_HOOK void         open_clock();
ROSCFE_HOOK void         open_parameters();
ROSCFE_HOOK void         set_private(const std::string &name, const char *value);
ROSCFE_HOOK bool enroll_with_master(Kind kind, const std::string &name, const char *type, const char *md5,
                                    const char *definition, Registration &place);
ROSCFE_HOOK void withdraw_name(Kind kind, const std::string &name);
ROSCFE_HOOK void ask_for_latched(const std::string &topic, std::uint8_t number);
ROSCFE_HOOK void tell_end(int status);
ROSCFE_HOOK void log_other_type(const Publication &there, const ros::AdvertiseOptions &options);
ROSCFE_HOOK bool call_handler_of_end(); // the node's own handler of SIGINT or SIGTERM, once; false when it has none

} // namespace roscfe

#endif
