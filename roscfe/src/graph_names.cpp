// What nodes seldom ask of names, and ros::this_node.
#include "core/core.h"
#include "ros/exceptions.h"
#include "ros/names.h"
#include "ros/this_node.h"
#include "roscfe/refuse.h"

namespace ros
{

namespace this_node
{

const std::string &getName()
{
    return roscfe::g_node.name;
}

const std::string &getNamespace()
{
    return roscfe::g_node.ns;
}

void getAdvertisedTopics(V_string &topics)
{
    topics.clear();
    for (const auto &each : roscfe::g_node.publications)
    {
        topics.push_back(each->topic_);
    }
}

void getSubscribedTopics(V_string &topics) // behind those that are there, as in roscpp
{
    for (const auto &each : roscfe::g_node.subscriptions)
    {
        topics.push_back(each->topic_);
    }
}

} // namespace this_node

namespace names
{

std::string parentNamespace(const std::string &name)
{
    std::string error;
    if (!validate(name, error))
    {
        ROSCFE_THROW(InvalidNameException(error));
    }
    if (name.empty() || name == "/")
    {
        return name;
    }
    // roscpp takes a last slash away together with the character before it.
    const std::string kept  = name.back() == '/' ? name.substr(0, name.size() - 2) : name;
    const std::size_t slash = kept.rfind('/');
    return slash == std::string::npos ? "" : slash == 0 ? "/" : kept.substr(0, slash);
}

const M_string &getRemappings()
{
    return roscfe::g_node.remappings;
}

const M_string &getUnresolvedRemappings()
{
    return roscfe::g_node.remappings;
}

} // namespace names
} // namespace ros
