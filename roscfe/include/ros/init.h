// Start and end of a node, and what it does in between.
#ifndef ROS_INIT_H
#define ROS_INIT_H

#include <string>

#include "ros/forwards.h"
#include "ros/spinner.h"

namespace ros
{

namespace init_options
{
enum InitOption
{
    NoSigintHandler = 1 << 0,
    AnonymousName   = 1 << 1,
    NoRosout        = 1 << 2
};
}
typedef init_options::InitOption InitOption;

void init(int &argc, char **argv, const std::string &name, std::uint32_t options = 0);
void init(const M_string &remappings, const std::string &name, std::uint32_t options = 0);
void init(const VP_string &remappings, const std::string &name, std::uint32_t options = 0);

bool isInitialized();
bool isStarted();
bool isShuttingDown();
void start();
void shutdown();
void requestShutdown();
void waitForShutdown();

// False once ES wants the application to end (CFE_ES_RunLoop), or the node was shut down.
bool ok();

void spin();
void spin(Spinner &spinner);
void spinOnce();

void removeROSArgs(int argc, const char *const *argv, V_string &args);
std::string getROSArg(int argc, const char *const *argv, const std::string &arg);

} // namespace ros

#endif
