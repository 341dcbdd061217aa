// MsgIds of names: from cfepy's ROS application where it runs, else from the tables that the convertor has made.
#include <cstring>

#include "internal.h"
#include "ros/this_node.h"
#include "roscfe/refuse.h"

namespace roscfe
{

namespace
{

void put_text(std::vector<std::uint8_t> &to, const char *text)
{
    const std::size_t size = std::strlen(text);
    for (int byte = 0; byte < 4; ++byte)
    {
        to.push_back(static_cast<std::uint8_t>(size >> (8 * byte)));
    }
    to.insert(to.end(), text, text + size);
}

// Ask the ROS application, as a service is called: the node's pipe, what, node, name, type, md5 sum, definition.
bool ask(Kind kind, Kind about, const std::string &name, const char *type, const char *md5, const char *definition,
         Registration &answer)
{
    static Client             master("", nullptr, nullptr);
    std::vector<std::uint8_t> request;
    const auto pipe = static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(g_node.pipe));
    for (int byte = 0; byte < 4; ++byte)
    {
        request.push_back(static_cast<std::uint8_t>(pipe >> (8 * byte)));
    }
    request.push_back(static_cast<std::uint8_t>(static_cast<int>(kind) | static_cast<int>(about)));
    put_text(request, g_node.name.c_str());
    put_text(request, name.c_str());
    put_text(request, type);
    put_text(request, md5);
    put_text(request, definition);
    std::uint8_t *at = master.begin(request.size());
    if (at == nullptr)
    {
        return false;
    }
    std::memcpy(at, request.data(), request.size());
    if (!master.call())
    {
        const std::string text(master.answer_.begin(), master.answer_.end());
        if (!text.empty())
        {
            CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s", text.c_str());
        }
        return false;
    }
    if (master.answer_.size() < 3)
    {
        return false;
    }
    answer.msg_id  = static_cast<std::uint16_t>(master.answer_[0] | master.answer_[1] << 8);
    answer.raw     = (master.answer_[2] & 1) != 0;
    answer.latched = (master.answer_[2] & 2) != 0;
    return true;
}

} // namespace

Registration enroll(Kind kind, const std::string &name, const char *type, const char *md5, const char *definition)
{
    Registration place;
    if (type == nullptr)
    {
        place.msg_id = kMasterMsgId; // the master itself, which needs nobody to find it
        return place;
    }
    if (g_node.has_master && ask(kind, Kind::begun, name, type, md5, definition, place))
    {
        return place;
    }
    if (kind == Kind::server || kind == Kind::client)
    {
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
    for (int i = 0; i < g_node.description->topic_count; ++i)
    {
        if (name == g_node.description->topics[i].name)
        {
            place.msg_id = g_node.description->topics[i].msg_id;
            place.raw    = g_node.description->topics[i].raw;
            return place;
        }
    }
    if (name == "/rosout")
    {
        place.msg_id = kRosoutMsgId;
        return place;
    }
    refuse("no MsgId for the topic; write it in the mission file's topics", name.c_str());
}

void withdraw_name(Kind kind, const std::string &name)
{
    Registration place;
    if (g_node.has_master)
    {
        ask(kind, Kind::gone, name, "", "", "", place);
    }
}

void ask_for_latched(const std::string &topic)
{
    Registration place;
    ask(Kind::subscriber, Kind::subscribed, topic, "", "", "", place);
}

} // namespace roscfe
