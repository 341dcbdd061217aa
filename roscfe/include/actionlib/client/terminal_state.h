// How a goal ended.
#ifndef ROSCFE_ACTIONLIB_CLIENT_TERMINAL_STATE_H
#define ROSCFE_ACTIONLIB_CLIENT_TERMINAL_STATE_H

#include <string>

namespace actionlib
{

class TerminalState
{
  public:
    enum StateEnum
    {
        RECALLED,
        REJECTED,
        PREEMPTED,
        ABORTED,
        SUCCEEDED,
        LOST
    };

    TerminalState(const StateEnum &state, const std::string &text = std::string()) : state_(state), text_(text) {}

    bool operator==(const TerminalState &other) const { return state_ == other.state_; }
    bool operator==(const StateEnum &other) const { return state_ == other; }
    bool operator!=(const TerminalState &other) const { return state_ != other.state_; }
    bool operator!=(const StateEnum &other) const { return state_ != other; }

    std::string getText() const { return text_; }
    std::string toString() const
    {
        static const char *const kNames[] = {"RECALLED", "REJECTED", "PREEMPTED", "ABORTED", "SUCCEEDED", "LOST"};
        return kNames[state_];
    }

    StateEnum   state_;
    std::string text_;
};

} // namespace actionlib

#endif
