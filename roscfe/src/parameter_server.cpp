// Parameters on cfepy: its ROS application keeps them for all nodes of a mission, those in Python, too. A node asks for each,
// but for those that it keeps: of their changes it is told by a notice.
#include <map>

#include "internal.h"
#include "json.h"
#include "roscfe/parts.h"

namespace roscfe
{

namespace parts
{
extern const char parameter_server = 0;
}

namespace server
{

using XmlRpc::XmlRpcValue;

namespace
{

constexpr std::size_t kAnswerAtOnce = 256; // bytes of an answer, before memory is needed for more

// A parameter that the node has asked for with getParamCached.
struct Cached
{
    bool        is_known = false; // nothing has changed since
    bool        is_there = false;
    XmlRpcValue value;
};
std::map<std::string, Cached> &kept()
{
    static std::map<std::string, Cached> all;
    return all;
}

// The text of an answer; false when the answer is no, or there is none. Nothing is asked while another answer is read, so
// the memory of both is used again.
bool ask(ParameterCall what, const std::string &name, const std::string &text, std::string &told)
{
    // The memory of two answers is used in turns: a number is asked for again, after a notice, without any more.
    static std::vector<std::uint8_t> answer = [] {
        std::vector<std::uint8_t> made;
        made.reserve(kAnswerAtOnce);
        return made;
    }();
    if (!call_master(static_cast<std::uint8_t>(what), name, text.c_str(), "", "", answer) || answer.empty() ||
        answer[0] == 0)
    {
        return false;
    }
    told.assign(answer.begin() + 1, answer.end());
    return true;
}

bool ask(ParameterCall what, const std::string &name, const std::string &text = std::string())
{
    std::string told;
    return ask(what, name, text, told);
}

bool value_of(ParameterCall what, const std::string &name, XmlRpcValue &value)
{
    static std::string told;
    if (!ask(what, name, "", told))
    {
        return false;
    }
    from_json(told.c_str(), value);
    return true;
}

// Whether one name is that of the other, or of a namespace around it.
bool is_about(std::string_view one, std::string_view other)
{
    const std::string_view shorter = one.size() < other.size() ? one : other;
    const std::string_view longer  = one.size() < other.size() ? other : one;
    return longer.compare(0, shorter.size(), shorter) == 0 &&
           (shorter.size() <= 1 || longer.size() == shorter.size() || longer[shorter.size()] == '/');
}

} // namespace

bool get(const std::string &name, XmlRpcValue &value)
{
    return value_of(ParameterCall::get, name, value);
}

bool get_cached(const std::string &name, XmlRpcValue &value)
{
    pump(0); // notices wait in the pipe
    const auto found  = kept().find(name);
    Cached &   cached = found != kept().end() ? found->second : kept()[name];
    if (!cached.is_known)
    {
        cached.is_known = true; // a notice that comes meanwhile says otherwise
        cached.is_there = value_of(ParameterCall::watch, name, cached.value);
    }
    if (cached.is_there)
    {
        value = cached.value;
    }
    return cached.is_there;
}

void forget_cached(std::string_view name)
{
    for (auto &each : kept())
    {
        if (is_about(each.first, name))
        {
            each.second.is_known = false;
        }
    }
}

void set(const std::string &name, const XmlRpcValue &value)
{
    ask(ParameterCall::set, name, value.toJson());
}

void give(const XmlRpcValue &tree)
{
    ask(ParameterCall::give, "/", tree.toJson());
}

bool has(const std::string &name)
{
    return ask(ParameterCall::has, name);
}

bool erase(const std::string &name)
{
    return ask(ParameterCall::erase, name);
}

bool search(const std::string &ns, const std::string &key, std::string &result)
{
    return ask(ParameterCall::search, key, ns, result);
}

void names(std::vector<std::string> &found)
{
    XmlRpcValue list;
    std::string told;
    found.clear();
    if (!ask(ParameterCall::names, "/", "", told))
    {
        return;
    }
    from_json(told.c_str(), list);
    for (int i = 0; list.getType() == XmlRpcValue::TypeArray && i < list.size(); ++i)
    {
        if (list[i].getType() == XmlRpcValue::TypeString)
        {
            found.push_back(static_cast<const std::string &>(list[i]));
        }
    }
}

} // namespace server
} // namespace roscfe
