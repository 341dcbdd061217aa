// Services: requests that come, calls that go out, and answers both ways.
#include <algorithm>
#include <cstring>

#include "internal.h"
#include "ros/init.h"
#include "ros/node_handle.h"
#include "ros/service.h"
#include "roscfe/parts.h"
#include "roscfe/refuse.h"

namespace roscfe
{

namespace
{

constexpr std::size_t  kRequestLead  = 4;           // number of the call
constexpr std::size_t  kAnswerLead   = 5;           // and whether it succeeded
constexpr std::int64_t kLook         = kSecond / 2; // how often a caller looks whether the service is still there
constexpr std::int64_t kPoll         = kSecond / 50; // how often somebody who waits for a service looks

// The one call that the node waits for. A callback that runs meanwhile may call, too, and comes back first.
struct Call
{
    std::uint16_t              msg_id;
    std::uint32_t              number;
    std::vector<std::uint8_t> *answer;
    std::size_t                most; // bytes of the answer; 0 is as many as it likes
    bool                       is_over;
    bool                       good;
    Call *                     outer;
};
Call *        g_call  = nullptr;
std::uint32_t g_calls = 0;

std::vector<std::uint8_t>  g_pieces;   // of a long request that comes
std::vector<std::uint8_t>  g_answer;   // that is under way
std::vector<std::uint16_t> g_listened; // answers that the node has asked for
std::size_t                g_clients = 0;

std::uint32_t number_at(const std::uint8_t *at)
{
    return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8 |
           static_cast<std::uint32_t>(at[2]) << 16 | static_cast<std::uint32_t>(at[3]) << 24;
}

void put_number(std::uint8_t *at, std::uint32_t number)
{
    for (int byte = 0; byte < 4; ++byte)
    {
        at[byte] = static_cast<std::uint8_t>(number >> (8 * byte));
    }
}

// Numbers of calls are the node's own, whoever else calls: the pipe's number is in them.
std::uint32_t new_number()
{
    const auto pipe = static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(g_node.pipe));
    g_calls         = (g_calls + 1) & 0xFFFF;
    return 0x80000000U | (pipe & 0x7FFF) << 16 | g_calls;
}

// Answers of a service that was called once are always taken; those to others are passed over.
bool listen_to_answers(std::uint16_t answer_id)
{
    if (std::find(g_listened.begin(), g_listened.end(), answer_id) != g_listened.end())
    {
        return true;
    }
    if (!listen(answer_id))
    {
        return false;
    }
    g_listened.push_back(answer_id);
    return true;
}

// Take bytes over. Where a message has a size at most, one byte more is enough for it to be refused.
void append(std::vector<std::uint8_t> &to, const std::uint8_t *bytes, std::size_t size, std::size_t lead,
            std::size_t most)
{
    const std::size_t room = lead + (most > 0 ? most : kLongestMessage) + 1;
    to.insert(to.end(), bytes, bytes + std::min(size, room - std::min(room, to.size())));
}

std::uint8_t segment_flags(const std::uint8_t *packet)
{
    return packet[2] >> 6; // 3 whole, 1 first, 0 in the middle, 2 last
}

} // namespace

// -- the side that serves ----------------------------------------------------------------------------------------------

void Service::set_aside(std::size_t most_of_request, std::size_t most_of_response)
{
    most_ = most_of_request;
    for (Request &each : waiting_)
    {
        each.bytes.reserve(most_ > 0 ? most_ + 1 : 0);
    }
    g_answer.reserve(most_of_response);
    g_pieces.reserve(most_ > 0 ? kRequestLead + most_ + 1 : 0);
}

bool Service::receive(std::uint32_t number, const std::uint8_t *bytes, std::size_t size)
{
    if (count_ == waiting_.size())
    {
        ++dropped_;
        ++g_counters.dropped;
        return false;
    }
    Request &place = waiting_[(head_ + count_) % waiting_.size()];
    place.number   = number;
    place.bytes.clear();
    append(place.bytes, bytes, size, 0, most_);
    ++count_;
    return true;
}

ros::CallbackInterface::CallResult Service::call_now()
{
    if (count_ == 0 || !alive_)
    {
        return Invalid;
    }
    Request &request = waiting_[head_];
    head_            = (head_ + 1) % waiting_.size();
    --count_;
    const ros::VoidConstPtr held = tracked_.lock();
    const std::uint32_t     number = request.number;
    const bool              good =
        (!has_tracked_ || held) && serve(request.bytes.data(), request.bytes.size());
    std::uint8_t lead[kAnswerLead];
    put_number(lead, number);
    lead[4] = good ? 1 : 0;
    g_answer.resize(good ? answer_length() : 0);
    if (good)
    {
        write_answer(g_answer.data(), g_answer.size());
    }
    send_bytes(answer_id_, lead, sizeof lead, g_answer.data(), g_answer.size());
    return Success;
}

bool take_request(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size)
{
    if ((msg_id & kCommandBit) == 0)
    {
        return false;
    }
    for (const boost::shared_ptr<Service> &each : g_node.services)
    {
        if ((each->answer_id_ | kCommandBit) != msg_id)
        {
            continue;
        }
        const std::size_t lead = kCommandHeader + kRequestLead;
        if (size < lead)
        {
            tell_ignored(Ignored::request, msg_id, size);
            return true;
        }
        const std::uint32_t number = number_at(packet + kCommandHeader);
        const std::uint8_t  flags  = segment_flags(packet);
        const std::uint8_t *bytes  = packet + lead;
        std::size_t         length = size - lead;
        if (flags != 3)
        {
            // One long request at a time: its number is in front of what is kept.
            if (flags == 1)
            {
                g_pieces.assign(packet + kCommandHeader, packet + lead);
            }
            else if (g_pieces.size() < kRequestLead || number_at(g_pieces.data()) != number)
            {
                return true;
            }
            append(g_pieces, bytes, length, kRequestLead, each->most_);
            if (flags != 2)
            {
                return true;
            }
            bytes  = g_pieces.data() + kRequestLead;
            length = g_pieces.size() - kRequestLead;
        }
        if (each->receive(number, bytes, length))
        {
            each->callbacks_->addCallback(each, reinterpret_cast<std::uintptr_t>(each.get()));
        }
        if (flags != 3)
        {
            g_pieces.clear();
        }
        return true;
    }
    return false;
}

Registration enroll_service(Kind kind, const std::string &name, const char *type, const char *md5)
{
    parts::need(parts::subscribers); // a caller asks whether there is a server
    Registration place;
    if (type == nullptr)
    {
        place.msg_id = kMasterMsgId; // the master itself, which needs nobody to find it
        return place;
    }
    if (enroll_with_master != nullptr && enroll_with_master(kind, name, type, md5, "", place))
    {
        return place;
    }
    for (int i = 0; i < g_node.description->service_count; ++i)
    {
        if (name == g_node.description->services[i].name)
        {
            place.msg_id = g_node.description->services[i].answer_msg_id;
            return place;
        }
    }
    refuse("no MsgId for the service; write it in the mission file's services", name.c_str());
}

void offer(const boost::shared_ptr<Service> &service, const char *type, const char *md5)
{
    service->answer_id_ = enroll_service(Kind::server, service->name_, type, md5).msg_id;
    service->callbacks_->expect(Service::kWaiting);
    g_node.services.push_back(service);
    if (!listen(service->answer_id_ | kCommandBit))
    {
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: no subscription for service %s", g_node.name.c_str(),
                          service->name_.c_str());
    }
}

void withdraw(const boost::shared_ptr<Service> &service)
{
    service->alive_ = false;
    auto &all       = g_node.services;
    all.erase(std::remove(all.begin(), all.end(), service), all.end());
    if (!g_node.ended)
    {
        service->callbacks_->removeByID(reinterpret_cast<std::uintptr_t>(service.get()));
        service->callbacks_->expect_no_more(Service::kWaiting);
        const auto request_id = static_cast<std::uint16_t>(service->answer_id_ | kCommandBit);
        CFE_SB_Unsubscribe(CFE_SB_ValueToMsgId(request_id), g_node.pipe);
        listen_no_more(request_id);
        if (withdraw_name != nullptr)
        {
            withdraw_name(Kind::server, service->name_);
        }
    }
}

// -- the side that calls -----------------------------------------------------------------------------------------------

namespace
{
std::vector<Client *> g_persistent; // clients that are connected with the one server that they have found
} // namespace

Client::Client(const std::string &name, const char *type, const char *md5, std::size_t most_of_request,
               std::size_t most_of_response, bool persistent)
    : name_(name), most_(most_of_response), is_master_(type == nullptr)
{
    const Registration place = enroll_service(Kind::client, name, type, md5);
    answer_id_               = place.msg_id;
    long_request_.reserve(most_of_request);
    answer_.reserve(most_ > 0 ? most_ + 1 : 0);
    g_listened.reserve(++g_clients);
    if (is_master_)
    {
        return;
    }
    send_from_now_on(request_id());
    if (g_node.has_master && !place.refused && g_node.knows_subscribers)
    {
        know_pipes(request_id(), place.pipes);
    }
    if (persistent)
    {
        const std::vector<CFE_SB_PipeId_t> servers = those_on(request_id());
        is_linked_ = !servers.empty() || !g_node.knows_subscribers;
        server_    = servers.empty() ? 0 : static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(servers.front()));
        g_persistent.push_back(this);
    }
}

Client::~Client()
{
    g_persistent.erase(std::remove(g_persistent.begin(), g_persistent.end(), this), g_persistent.end());
}

void clients_lost_server(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    for (Client *each : g_persistent)
    {
        each->lose(msg_id, static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe)));
    }
}

std::uint16_t Client::request_id() const
{
    return answer_id_ | kCommandBit;
}

void Client::lose(std::uint16_t request_id_of_server, std::uint32_t server)
{
    // Of a server that was there before, nobody says which pipe it has.
    is_linked_ = is_linked_ && (request_id_of_server != request_id() || (server_ != 0 && server != server_));
}

bool Client::is_linked()
{
    pump(0);
    is_linked_ = is_linked_ && (!g_node.knows_subscribers ||
                                hears(CFE_SB_PIPEID_C(CFE_ResourceId_FromInteger(server_)), request_id()));
    return is_linked_;
}

bool Client::exists() const
{
    if (g_node.is_shut && !is_master_)
    {
        return false; // the node has left the graph, and asks it for nothing
    }
    pump(0);
    if (!is_master_) // which was there at the start; a call looks if it is not answered
    {
        check_pipes_on(request_id());
    }
    return !g_node.knows_subscribers || pipes_on(request_id()) > 0;
}

bool Client::wait_for_existence(std::int64_t timeout_ns)
{
    const std::int64_t until = now_ns() + timeout_ns;
    while (!exists())
    {
        const std::int64_t now = now_ns();
        if (!ros::ok() || (timeout_ns >= 0 && now >= until))
        {
            return false;
        }
        pump(timeout_ns >= 0 ? std::min(until, now + kPoll) : now + kPoll);
        if (run_async != nullptr)
        {
            run_async();
        }
    }
    return true;
}

std::uint8_t *Client::begin(std::size_t size)
{
    if (!exists())
    {
        return nullptr;
    }
    if (waits_for_answer())
    {
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: a callback calls %s with a client that waits for its answer",
                          g_node.name.c_str(), name_.c_str());
        return nullptr;
    }
    size_ = size;
    long_request_.resize(std::max<std::size_t>(size, 1)); // an empty request has an address, too
    return long_request_.data();
}

// A callback that runs during a call may call other services, and this one with a client of its own.
bool Client::waits_for_answer() const
{
    const Call *call = g_call;
    while (call != nullptr && call->answer != &answer_)
    {
        call = call->outer;
    }
    return call != nullptr;
}

// Whether an answer may still come: whoever serves is there, and the node is not to end. The master answers until then.
bool Client::may_be_answered() const
{
    check_pipes_on(request_id());
    return (is_master_ || ros::ok()) && (!g_node.knows_subscribers || pipes_on(request_id()) > 0);
}

bool Client::call()
{
    Call this_call = {answer_id_, new_number(), &answer_, most_, false, false, g_call};
    if (!listen_to_answers(answer_id_))
    {
        return false;
    }
    g_call = &this_call;
    answer_.clear();
    std::uint8_t lead[kRequestLead];
    put_number(lead, this_call.number);
    send_bytes(request_id(), lead, sizeof lead, long_request_.data(), size_);
    std::int64_t look = now_ns() + kLook;
    while (!this_call.is_over && (is_master_ || !g_node.shutting_down))
    {
        pump(look);
        if (!is_master_ && !this_call.is_over && run_async != nullptr)
        {
            run_async(); // the answer may come from a service of this node
        }
        if (!this_call.is_over && now_ns() >= look)
        {
            look = now_ns() + kLook;
            if (!may_be_answered())
            {
                break;
            }
        }
    }
    g_call = this_call.outer;
    return this_call.is_over && this_call.good;
}

bool take_answer(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size)
{
    const std::size_t lead = kTelemetryHeader + kAnswerLead;
    if (server::forget_cached != nullptr && msg_id == kMasterMsgId && size >= lead && number_at(packet + kTelemetryHeader) == 0)
    {
        server::forget_cached(std::string_view(reinterpret_cast<const char *>(packet) + lead, size - lead)); // a notice
        return true;
    }
    for (Call *call = g_call; call != nullptr; call = call->outer)
    {
        if (call->msg_id != msg_id)
        {
            continue;
        }
        if (size < lead)
        {
            tell_ignored(Ignored::answer, msg_id, size);
            return true;
        }
        if (number_at(packet + kTelemetryHeader) != call->number || call->is_over)
        {
            continue; // an answer to somebody else
        }
        const std::uint8_t flags = segment_flags(packet);
        call->good = packet[lead - 1] != 0;
        if (call->good || msg_id == kMasterMsgId) // of another service nobody asks for the text of an error
        {
            append(*call->answer, packet + lead, size - lead, 0, call->most);
        }
        call->is_over = flags == 3 || flags == 2;
        return true;
    }
    return false;
}

bool wait_for_service(const std::string &name, std::int64_t timeout_ns)
{
    return Client(name, "*", "*").wait_for_existence(timeout_ns);
}

bool service_exists(const std::string &name)
{
    return Client(name, "*", "*").exists();
}

} // namespace roscfe

namespace ros
{

ServiceServer NodeHandle::advertiseService(AdvertiseServiceOptions &options)
{
    if (roscfe::g_node.is_shut)
    {
        return ServiceServer();
    }
    CallbackQueueInterface *queue = options.callback_queue != nullptr ? options.callback_queue : getCallbackQueue();
    auto                    made  = options.make(resolveName(options.service), queue);
    made->tracked_                = options.tracked_object;
    made->has_tracked_            = options.tracked_object != nullptr;
    roscfe::offer(made, options.type, options.service_md5);
    return ServiceServer(made);
}

ServiceClient NodeHandle::serviceClient(ServiceClientOptions &options)
{
    return ServiceClient(resolveName(options.service), options.persistent, options.type.c_str(),
                         options.md5sum.c_str(), options.request_bytes, options.response_bytes);
}

ServiceServer::ServiceServer(const boost::shared_ptr<roscfe::Service> &service)
    : handle_(boost::make_shared<Handle>(service))
{
}

void ServiceServer::Handle::release()
{
    if (service)
    {
        const boost::shared_ptr<roscfe::Service> was = service;
        service.reset();
        roscfe::withdraw(was);
    }
}

void ServiceServer::shutdown()
{
    if (handle_)
    {
        handle_->release();
    }
}

std::string ServiceServer::getService() const
{
    return *this ? handle_->service->name_ : std::string();
}

ServiceClient::ServiceClient(const std::string &name, bool persistent, const char *type, const char *md5,
                             std::size_t most_of_request, std::size_t most_of_response)
    : client_(boost::make_shared<roscfe::Client>(name, type, md5, most_of_request, most_of_response, persistent)),
      persistent_(persistent)
{
}

bool ServiceClient::isValid() const
{
    return client_ != nullptr && (!persistent_ || client_->is_linked());
}

void ServiceClient::shutdown()
{
    if (client_)
    {
        client_->unlink();
    }
}

bool ServiceClient::waitForExistence(Duration timeout)
{
    return client_ && client_->wait_for_existence(timeout.toNSec());
}

namespace service
{

bool exists(const std::string &name, bool print_failure_reason)
{
    const std::string resolved = names::resolve(name);
    const bool        there    = roscfe::service_exists(resolved);
    if (!there && print_failure_reason)
    {
        CFE_EVS_SendEvent(roscfe::kBusEid, CFE_EVS_EventType_INFORMATION, "waitForService: Service [%s] has not been "
                          "advertised, waiting...", resolved.c_str());
    }
    return there;
}

bool waitForService(const std::string &name, std::int32_t timeout_ms)
{
    return roscfe::wait_for_service(names::resolve(name), timeout_ms * roscfe::kMillisecond);
}

bool waitForService(const std::string &name, Duration timeout)
{
    return roscfe::wait_for_service(names::resolve(name), timeout.toNSec());
}

} // namespace service

} // namespace ros
