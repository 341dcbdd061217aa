// ros::this_node: the name of this node, and what it offers and hears.
#ifndef ROSCPP_THIS_NODE_H
#define ROSCPP_THIS_NODE_H

#include <string>

#include "ros/forwards.h"

namespace ros
{
namespace this_node
{

const std::string &getName();
const std::string &getNamespace();
void               getAdvertisedTopics(V_string &topics);
void               getSubscribedTopics(V_string &topics);

} // namespace this_node
} // namespace ros

#endif
