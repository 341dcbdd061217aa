// Where a goal is between client and server, as a client with handles sees it.
#ifndef ROSCFE_ACTIONLIB_CLIENT_COMM_STATE_H
#define ROSCFE_ACTIONLIB_CLIENT_COMM_STATE_H

#include <string>

namespace actionlib
{

class CommState
{
  public:
    enum StateEnum
    {
        WAITING_FOR_GOAL_ACK   = 0,
        PENDING                = 1,
        ACTIVE                 = 2,
        WAITING_FOR_RESULT     = 3,
        WAITING_FOR_CANCEL_ACK = 4,
        RECALLING              = 5,
        PREEMPTING             = 6,
        DONE                   = 7
    };

    CommState(const StateEnum &state) : state_(state) {}

    bool operator==(const CommState &other) const { return state_ == other.state_; }
    bool operator==(const StateEnum &other) const { return state_ == other; }
    bool operator!=(const CommState &other) const { return state_ != other.state_; }
    bool operator!=(const StateEnum &other) const { return state_ != other; }

    std::string toString() const
    {
        static const char *const kNames[] = {"WAITING_FOR_GOAL_ACK",   "PENDING",   "ACTIVE",     "WAITING_FOR_RESULT",
                                             "WAITING_FOR_CANCEL_ACK", "RECALLING", "PREEMPTING", "DONE"};
        return kNames[state_];
    }

    StateEnum state_;
};

} // namespace actionlib

#endif
