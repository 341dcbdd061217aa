// The master: cfepy's ROS application where it runs. MsgIds of names come from it.
#include <cstring>

#include "internal.h"
#include "ros/this_node.h"
#include "roscfe/parts.h"

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

// Ask the ROS application about a name.
bool ask(Kind kind, Kind about, const std::string &name, const char *type, const char *md5, const char *definition,
         Registration &place)
{
    std::vector<std::uint8_t> answer;
    const auto                what = static_cast<std::uint8_t>(static_cast<int>(kind) | static_cast<int>(about));
    if (!call_master(what, name, type, md5, definition, answer) || answer.size() < 3)
    {
        place.refused = !answer.empty();
        return false;
    }
    place.msg_id  = static_cast<std::uint16_t>(answer[0] | answer[1] << 8);
    place.raw     = (answer[2] & 1) != 0;
    place.latched = (answer[2] & 2) != 0;
    for (std::size_t at = 3; at + 4 <= answer.size(); at += 4)
    {
        const auto number = static_cast<std::uint32_t>(answer[at]) | static_cast<std::uint32_t>(answer[at + 1]) << 8 |
                            static_cast<std::uint32_t>(answer[at + 2]) << 16 |
                            static_cast<std::uint32_t>(answer[at + 3]) << 24;
        place.pipes.push_back(CFE_SB_PIPEID_C(CFE_ResourceId_FromInteger(number)));
    }
    return true;
}

} // namespace

// As a service is called: the node's pipe, what, node, name, and three texts.
bool call_master(std::uint8_t what, const std::string &name, const char *one, const char *two, const char *three,
                 std::vector<std::uint8_t> &answer)
{
    static Client                    master("", nullptr, nullptr);
    static std::vector<std::uint8_t> request; // its memory is used again
    request.clear();
    const auto pipe = static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(g_node.pipe));
    for (int byte = 0; byte < 4; ++byte)
    {
        request.push_back(static_cast<std::uint8_t>(pipe >> (8 * byte)));
    }
    request.push_back(what);
    put_text(request, g_node.name.c_str());
    put_text(request, name.c_str());
    for (const char *text : {one, two, three})
    {
        put_text(request, text);
    }
    std::uint8_t *at = master.begin(request.size());
    if (at == nullptr)
    {
        return false;
    }
    std::memcpy(at, request.data(), request.size());
    const bool good = master.call();
    answer.swap(master.answer_);
    if (!good && !answer.empty())
    {
        const std::string text(answer.begin(), answer.end());
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s", text.c_str());
    }
    return good;
}

bool enroll_with_master(Kind kind, const std::string &name, const char *type, const char *md5, const char *definition,
                        Registration &place)
{
    parts::need(parts::parameter_server); // whoever has a master has parameters there
    return g_node.has_master && (ask(kind, Kind::begun, name, type, md5, definition, place) || place.refused);
}

void withdraw_name(Kind kind, const std::string &name)
{
    Registration place;
    if (g_node.has_master)
    {
        ask(kind, Kind::gone, name, "", "", "", place);
    }
}

// cfepy looks after its nodes as roslaunch does: one that ends by itself may be required, or is started again.
void tell_end(int status)
{
    static bool               is_told = false; // what ends the node on the way does not tell it again
    std::vector<std::uint8_t> answer;
    if (is_told || !g_node.has_master || g_node.asked_to_end)
    {
        return;
    }
    is_told         = true;
    const bool told = call_master(kEnded, g_node.description->app, std::to_string(status).c_str(), "", "", answer);
    if (!told || answer.size() < 5 || answer[0] == 0)
    {
        return;
    }
    CFE_ES_AppId_t app;
    const auto     delay_ms = static_cast<std::uint32_t>(answer[1]) | static_cast<std::uint32_t>(answer[2]) << 8 |
                          static_cast<std::uint32_t>(answer[3]) << 16 | static_cast<std::uint32_t>(answer[4]) << 24;
    OS_TaskDelay(delay_ms);
    std::uint32_t run = CFE_ES_RunStatus_APP_RUN;
    CFE_ES_RunLoop(&run); // ES restarts what it has seen running
    if (CFE_ES_GetAppID(&app) == CFE_SUCCESS)
    {
        CFE_ES_RestartApp(app); // takes place when the task has ended
    }
}

ros::M_stringPtr connection_header(const std::string &topic)
{
    static std::map<std::string, ros::M_stringPtr> known;
    ros::M_stringPtr &                             header = known[topic];
    if (header)
    {
        return header;
    }
    // Without cfepy's ROS application nobody knows: it is any type.
    header = boost::make_shared<ros::M_string>(ros::M_string{{"topic", topic}, {"callerid", "unknown_publisher"},
                                                             {"type", "*"}, {"md5sum", "*"}, {"message_definition", ""},
                                                             {"latching", "0"}});
    std::vector<std::uint8_t> answer;
    if (!g_node.has_master || !call_master(kTypeOfTopic, topic, "", "", "", answer))
    {
        return header;
    }
    std::size_t at = 0;
    for (const char *name : {"type", "md5sum", "message_definition", "latching"})
    {
        std::uint32_t size = 0;
        if (at + 4 > answer.size())
        {
            break;
        }
        for (int byte = 0; byte < 4; ++byte)
        {
            size |= static_cast<std::uint32_t>(answer[at++]) << (8 * byte);
        }
        if (size > answer.size() - at)
        {
            break;
        }
        (*header)[name].assign(reinterpret_cast<const char *>(answer.data()) + at, size);
        at += size;
    }
    return header;
}

void ask_for_latched(const std::string &topic, std::uint8_t number)
{
    Registration place;
    ask(Kind::subscriber, Kind::subscribed, topic, std::to_string(number).c_str(), "", "", place);
}

} // namespace roscfe
