// Ids of goals: the node's name, a count and the time.
#ifndef ROSCFE_ACTIONLIB_GOAL_ID_GENERATOR_H
#define ROSCFE_ACTIONLIB_GOAL_ID_GENERATOR_H

#include <cstdio>
#include <string>

#include "actionlib_msgs/GoalID.h"
#include "ros/this_node.h"
#include "ros/time.h"

namespace actionlib
{

class GoalIDGenerator
{
  public:
    GoalIDGenerator() = default;
    explicit GoalIDGenerator(const std::string &name) : name_(name) {}
    void setName(const std::string &name) { name_ = name; }

    actionlib_msgs::GoalID generateID()
    {
        static unsigned        count = 0; // of this node
        actionlib_msgs::GoalID id;
        id.stamp = ros::Time::now();
        char numbers[64];
        std::snprintf(numbers, sizeof numbers, "-%u-%u.%u", ++count, static_cast<unsigned>(id.stamp.sec),
                      static_cast<unsigned>(id.stamp.nsec));
        id.id = ((name_.empty() ? ros::this_node::getName() : name_) + numbers).c_str();
        return id;
    }

  private:
    std::string name_;
};

} // namespace actionlib

#endif
