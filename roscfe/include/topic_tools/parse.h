// topic_tools::getBaseName: the last part of a topic's name.
#ifndef TOPIC_TOOLS_PARSE_H
#define TOPIC_TOOLS_PARSE_H

#include <string>

#include "ros/console.h"

namespace topic_tools
{

// False where there is none, which is logged.
inline bool getBaseName(const std::string &full_name, std::string &base_name)
{
    const std::size_t last = full_name.find_last_not_of('/');
    if (last == std::string::npos)
    {
        ROS_ERROR("Base name extracted from \"%s\" is an empty string", full_name.c_str());
        return false;
    }
    const std::size_t slash = full_name.rfind('/', last);
    base_name               = full_name.substr(slash + 1, last - slash);
    return true;
}

} // namespace topic_tools

#endif
