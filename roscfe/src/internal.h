// What the parts of the core share: the state of the one node that this shared object is.
#ifndef ROSCFE_INTERNAL_H
#define ROSCFE_INTERNAL_H

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/core.h"

extern "C" {
#include "cfe_msgids.h"
#include "cfe_sb_msg.h"
}

#include "ros/param.h"
#include "ros/timer.h"
#include "roscfe/service.h"
#include "roscfe/waiting.h"

namespace roscfe
{

constexpr std::uint16_t kCommandBit      = 0x1000; // requests of a service are commands, its answers telemetry
constexpr std::uint16_t kMasterMsgId     = 0x08FC; // of the answers of cfepy's ROS application, as of a service
constexpr std::size_t   kLongestKey      = 256; // characters of a parameter's name that is looked up without memory
constexpr std::size_t   kLongestMessage  = 1U << 28; // bytes that are joined from packets, where no type says how many

// Send bytes behind a header and a lead that each packet repeats, in as many packets as it takes (long_messages.cpp).
void send_bytes(std::uint16_t msg_id, const std::uint8_t *lead, std::size_t lead_size, const std::uint8_t *bytes,
                std::size_t size);

// A packet is none of its kind, since it ends early or what it says of itself cannot be; an event says so, once a kind.
enum class Ignored : std::uint8_t
{
    report,
    request,
    answer
};
void tell_ignored(Ignored what, std::uint16_t msg_id, std::size_t size);

// -- subscribers.cpp: who else listens ---------------------------------------------------------------------------------

// The pipe has another subscription to what it hears: publishers send it the last message that they have latched.
ROSCFE_HOOK void ask_for_repetition(std::uint16_t msg_id, std::uint8_t number);

// The pipes that have subscribed to a MsgId; 0 stands for those of which only that they are there is known.
ROSCFE_HOOK std::vector<CFE_SB_PipeId_t> those_on(std::uint16_t msg_id);
bool                                     has_name(CFE_SB_PipeId_t pipe); // whether a pipe is one of this processor
bool                                     hears(CFE_SB_PipeId_t pipe, std::uint16_t msg_id);
// Ask whether subscriptions without a pipe are still there, at most once a second.
void check_pipes_on(std::uint16_t msg_id);

// -- latching.cpp, services.cpp: what they do when subscribers come and go ---------------------------------------------

ROSCFE_HOOK void publication_has_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe);
ROSCFE_HOOK void publication_has_another(std::uint16_t msg_id, CFE_SB_PipeId_t pipe, std::uint8_t number);
ROSCFE_HOOK void publication_lost_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe);
ROSCFE_HOOK void clients_lost_server(std::uint16_t msg_id, CFE_SB_PipeId_t pipe);

// -- others ------------------------------------------------------------------------------------------------------------

ROSCFE_HOOK void reset_ros_timers(std::int64_t now);
void             reserve_keys();

// The MsgId of a service's answers: what cfepy's ROS application says, else what the convertor has compiled in.
Registration enroll_service(Kind kind, const std::string &name, const char *type, const char *md5);

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
ROSCFE_HOOK bool get(const std::string &name, XmlRpc::XmlRpcValue &value);
ROSCFE_HOOK bool get_cached(const std::string &name, XmlRpc::XmlRpcValue &value);
ROSCFE_HOOK void forget_cached(std::string_view name); // it has changed, or what is in it
ROSCFE_HOOK void set(const std::string &name, const XmlRpc::XmlRpcValue &value);
ROSCFE_HOOK void give(const XmlRpc::XmlRpcValue &tree);
ROSCFE_HOOK bool has(const std::string &name);
ROSCFE_HOOK bool erase(const std::string &name);
ROSCFE_HOOK bool search(const std::string &ns, const std::string &key, std::string &result);
ROSCFE_HOOK void names(std::vector<std::string> &found);
} // namespace server

constexpr std::uint8_t kEnded = 32; // what call_master is told by a node that ends by itself

// A call of cfepy's ROS application; false when it refuses, which an event says. What else is asked are texts.
bool call_master(std::uint8_t what, const std::string &name, const char *one, const char *two, const char *three,
                 std::vector<std::uint8_t> &answer);

} // namespace roscfe

#endif
