// States of a goal as a simple client sees them.
#ifndef ROSCFE_ACTIONLIB_CLIENT_SIMPLE_GOAL_STATE_H
#define ROSCFE_ACTIONLIB_CLIENT_SIMPLE_GOAL_STATE_H

#include <string>

namespace actionlib
{

class SimpleClientGoalState
{
  public:
    enum StateEnum
    {
        PENDING,
        ACTIVE,
        RECALLED,
        REJECTED,
        PREEMPTED,
        ABORTED,
        SUCCEEDED,
        LOST
    };

    SimpleClientGoalState(StateEnum state, const std::string &text = std::string()) : state_(state), text_(text) {}

    bool operator==(const SimpleClientGoalState &other) const { return state_ == other.state_; }
    bool operator==(StateEnum other) const { return state_ == other; }
    bool operator!=(const SimpleClientGoalState &other) const { return state_ != other.state_; }
    bool operator!=(StateEnum other) const { return state_ != other; }

    bool               isDone() const { return state_ != PENDING && state_ != ACTIVE; }
    const std::string &getText() const { return text_; }
    std::string        toString() const
    {
        static const char *const kNames[] = {"PENDING",   "ACTIVE",  "RECALLED",  "REJECTED",
                                             "PREEMPTED", "ABORTED", "SUCCEEDED", "LOST"};
        return kNames[state_];
    }

    StateEnum   state_;
    std::string text_;
};

} // namespace actionlib

#endif
