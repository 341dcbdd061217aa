// Names of parameters, which nodes look up again and again: in memory that is used again.
#include "internal.h"
#include "ros/names.h"
#include "ros/node_handle.h"

namespace roscfe
{

namespace
{

std::string g_key_of_handle, g_key;

bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// A name in a namespace, without a slash twice or at the end; false for one that is not as most names are.
bool join(const std::string &ns, std::string_view name, std::string &full)
{
    if (name.empty() || name == "/" || !(is_letter(name[0]) || name[0] == '/'))
    {
        return false;
    }
    const std::string_view before = name[0] == '/' ? std::string_view() : std::string_view(ns);
    full                          = "/";
    for (const std::string_view part : {before, std::string_view("/"), name})
    {
        for (const char c : part)
        {
            if (!is_letter(c) && !(c >= '0' && c <= '9') && c != '/' && c != '_')
            {
                return false;
            }
            if (c != '/' || full.back() != '/')
            {
                full += c;
            }
        }
    }
    if (full.back() == '/')
    {
        full.pop_back();
    }
    return !full.empty();
}

const std::string &remapped_key(const std::string &full)
{
    const auto found = g_node.remappings.find(full);
    return found != g_node.remappings.end() ? found->second : full;
}

} // namespace

const std::string &full_key(Name key)
{
    const std::string_view text       = key.view();
    const bool             is_private = text.size() > 1 && text[0] == '~';
    const bool is_plain = is_private ? join(g_node.name, text.substr(text[1] == '/' ? 2 : 1), g_key) : join(g_node.ns, text, g_key);
    if (!is_plain)
    {
        g_key = ros::names::resolve(key.str());
        return g_key;
    }
    return remapped_key(g_key);
}

void reserve_keys()
{
    g_key_of_handle.reserve(kLongestKey);
    g_key.reserve(kLongestKey);
}

} // namespace roscfe

namespace ros
{

const std::string &NodeHandle::full_key(roscfe::Name key) const
{
    std::string &full = roscfe::g_key_of_handle;
    if (key.view().substr(0, 1) == "~" || !roscfe::join(namespace_, key, full))
    {
        full = resolveName(key.str());
        return full;
    }
    const auto found = remappings_.find(full);
    return found != remappings_.end() ? found->second : roscfe::remapped_key(full);
}

} // namespace ros
