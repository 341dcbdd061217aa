// ros::names: resolution and remapping of graph resource names (http://wiki.ros.org/Names).
#ifndef ROSCPP_NAMES_H
#define ROSCPP_NAMES_H

#include <string>

#include "ros/forwards.h"

namespace ros
{
namespace names
{

std::string     clean(const std::string &name);
std::string     resolve(const std::string &name, bool remap = true);
std::string     resolve(const std::string &ns, const std::string &name, bool remap = true);
std::string     append(const std::string &left, const std::string &right);
std::string     remap(const std::string &name);
bool            validate(const std::string &name, std::string &error);
std::string     parentNamespace(const std::string &name);
const M_string &getRemappings();
const M_string &getUnresolvedRemappings();

} // namespace names
} // namespace ros

#endif
