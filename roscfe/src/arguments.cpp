// What nodes seldom ask of their life, and arguments of a program.
#include <cstring>

#include "core/core.h"
#include "ros/init.h"
#include "ros/rate.h"
#include "ros/time.h"

namespace ros
{

using roscfe::g_node;

void init(const M_string &remappings, const std::string &name, std::uint32_t options)
{
    roscfe::initialize(name, options);
    for (const auto &each : remappings)
    {
        roscfe::remap(each.first, each.second);
    }
}

void init(const VP_string &remappings, const std::string &name, std::uint32_t options)
{
    roscfe::initialize(name, options);
    for (const auto &each : remappings)
    {
        roscfe::remap(each.first, each.second);
    }
}

bool isInitialized()
{
    return g_node.initialized;
}

bool isStarted()
{
    return g_node.started && !g_node.is_shut; // requestShutdown() changes nothing yet
}

bool isShuttingDown()
{
    return g_node.shutting_down;
}

// In roscpp a thread shuts down then, a little later: until then the node is on the graph.
void requestShutdown()
{
    g_node.shutting_down = true;
}

void waitForShutdown()
{
    while (ok())
    {
        WallDuration(0.5).sleep();
    }
}

void removeROSArgs(int argc, const char *const *argv, V_string &args)
{
    args.clear();
    for (int i = 0; i < argc; ++i)
    {
        if (std::strstr(argv[i], ":=") == nullptr)
        {
            args.push_back(argv[i]);
        }
    }
}

std::string getROSArg(int argc, const char *const *argv, const std::string &arg)
{
    const std::string lead = arg + ":=";
    for (int i = 0; i < argc; ++i)
    {
        if (std::strncmp(argv[i], lead.c_str(), lead.size()) == 0)
        {
            return argv[i] + lead.size();
        }
    }
    return std::string();
}

} // namespace ros
