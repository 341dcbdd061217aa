// Where a goal of an action is between client and server.
#ifndef ROSCFE_GOAL_PROGRESS_H
#define ROSCFE_GOAL_PROGRESS_H

namespace roscfe
{

class GoalProgress
{
  public:
    enum State
    {
        kWaitingForAck,
        kPending,
        kActive,
        kWaitingForResult,
        kWaitingForCancelAck,
        kRecalling,
        kPreempting,
        kDone
    };
    static constexpr int kMostSteps = 3;

    // The states that a status of the server leads through, from a state; their number, or -1 when it cannot be.
    static int steps(State from, unsigned status, State (&to)[kMostSteps]);
};

} // namespace roscfe

#endif
