// Names and their resolution (http://wiki.ros.org/Names).
#include "core.h"
#include "ros/exceptions.h"
#include "ros/names.h"
#include "ros/node_handle.h"
#include "roscfe/refuse.h"

namespace ros
{

namespace names
{

namespace
{

bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

[[noreturn]] void invalid(const std::string &what)
{
    ROSCFE_THROW(InvalidNameException(what));
}

} // namespace

bool validate(const std::string &name, std::string &error)
{
    if (name.empty())
    {
        return true;
    }
    if (!is_letter(name[0]) && name[0] != '/' && name[0] != '~')
    {
        error = "Character [" + name.substr(0, 1) + "] is not valid as the first character in Graph Resource Name [" +
                name + "].  Valid characters are a-z, A-Z, / and in some cases ~.";
        return false;
    }
    for (std::size_t i = 1; i < name.size(); ++i)
    {
        const char c = name[i];
        if (!is_letter(c) && !(c >= '0' && c <= '9') && c != '/' && c != '_')
        {
            error = "Character [" + name.substr(i, 1) + "] at element [" + std::to_string(i) +
                    "] is not valid in Graph Resource Name [" + name +
                    "].  Valid characters are a-z, A-Z, 0-9, / and _.";
            return false;
        }
    }
    return true;
}

std::string clean(const std::string &name)
{
    std::string cleaned;
    for (const char c : name)
    {
        if (c != '/' || cleaned.empty() || cleaned.back() != '/')
        {
            cleaned += c;
        }
    }
    if (!cleaned.empty() && cleaned.back() == '/') // of "/" nothing is left, as in roscpp
    {
        cleaned.pop_back();
    }
    return cleaned;
}

std::string append(const std::string &left, const std::string &right)
{
    return clean(left + "/" + right);
}

std::string remap(const std::string &name)
{
    const auto found = roscfe::g_node.remappings.find(resolve(name, false));
    return found != roscfe::g_node.remappings.end() ? found->second : name;
}

std::string resolve(const std::string &name, bool remap)
{
    return resolve(roscfe::g_node.ns, name, remap);
}

std::string resolve(const std::string &ns, const std::string &name, bool remap)
{
    std::string error;
    if (!validate(name, error))
    {
        invalid(error);
    }
    if (name.empty())
    {
        return ns.empty() ? "/" : ns[0] == '/' ? ns : append("/", ns);
    }
    std::string full = name;
    if (full[0] == '~')
    {
        full = append(roscfe::g_node.name, full.substr(1));
    }
    if (full[0] != '/')
    {
        full = append("/", append(ns, full));
    }
    full = clean(full);
    if (remap)
    {
        const auto found = roscfe::g_node.remappings.find(full);
        if (found != roscfe::g_node.remappings.end())
        {
            full = found->second;
        }
    }
    return full;
}

} // namespace names

// -- ros::NodeHandle ---------------------------------------------------------------------------------------------------

NodeHandle::NodeHandle(const std::string &ns, const M_string &remappings)
{
    start();
    std::string given = ns;
    if (!given.empty() && given[0] == '~')
    {
        given = names::resolve(given);
    }
    unresolved_namespace_ = given;
    namespace_            = roscfe::g_node.ns;
    namespace_            = resolveName(given, true);
    for (const auto &each : remappings)
    {
        remappings_[resolveName(each.first, false)] = resolveName(each.second, false);
    }
}

NodeHandle::NodeHandle(const NodeHandle &other) = default;

NodeHandle::NodeHandle(const NodeHandle &parent, const std::string &ns) : NodeHandle(parent, ns, M_string()) {}

NodeHandle::NodeHandle(const NodeHandle &parent, const std::string &ns, const M_string &remappings)
    : namespace_(parent.namespace_), unresolved_namespace_(ns), queue_(parent.queue_), remappings_(parent.remappings_)
{
    namespace_ = resolved(ns, true);
    for (const auto &each : remappings)
    {
        remappings_[resolveName(each.first, false)] = resolveName(each.second, false);
    }
}

NodeHandle::~NodeHandle() = default;

NodeHandle &NodeHandle::operator=(const NodeHandle &other) = default;

std::string NodeHandle::resolveName(const std::string &name, bool remap) const
{
    std::string error;
    if (!names::validate(name, error))
    {
        names::invalid(error);
    }
    return resolved(name, remap);
}

std::string NodeHandle::resolved(const std::string &name, bool remap) const
{
    if (name.empty())
    {
        return namespace_;
    }
    if (name[0] == '~')
    {
        ROSCFE_THROW(InvalidNameException("Using ~ names with NodeHandle methods is not allowed.  If you want to use "
                                          "private names with the NodeHandle interface, construct a NodeHandle using a "
                                          "private name as its namespace.  e.g. ros::NodeHandle nh(\"~\");  "
                                          "nh.getParam(\"my_private_name\"); (name = [" +
                                          name + "])"));
    }
    std::string full = names::clean(name[0] == '/' || namespace_.empty() ? name : names::append(namespace_, name));
    if (remap)
    {
        full = remapped(resolveName(full, false));
    }
    return names::resolve(full, false);
}

std::string NodeHandle::remapped(const std::string &resolved) const
{
    const auto found = remappings_.find(resolved);
    return found != remappings_.end() ? found->second : names::remap(resolved);
}

} // namespace ros
