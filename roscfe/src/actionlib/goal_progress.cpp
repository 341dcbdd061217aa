// How a client follows a goal by the statuses that the server sends (http://wiki.ros.org/actionlib/DetailedDescription).
#include "roscfe/goal_progress.h"

namespace roscfe
{

namespace
{

typedef GoalProgress S;

constexpr int kStatuses = 9; // PENDING to RECALLED

struct Path
{
    int      count;
    S::State to[GoalProgress::kMostSteps];
};

constexpr Path kNone    = {0, {S::kDone, S::kDone, S::kDone}};
constexpr Path kNever   = {-1, {S::kDone, S::kDone, S::kDone}};
constexpr Path one(S::State a)
{
    return {1, {a, S::kDone, S::kDone}};
}
constexpr Path two(S::State a, S::State b)
{
    return {2, {a, b, S::kDone}};
}
constexpr Path three(S::State a, S::State b, S::State c)
{
    return {3, {a, b, c}};
}

// In the order of actionlib_msgs/GoalStatus: PENDING, ACTIVE, PREEMPTED, SUCCEEDED, ABORTED, REJECTED, PREEMPTING,
// RECALLING, RECALLED; a line for each state.
constexpr Path kPaths[][kStatuses] = {
    {one(S::kPending), one(S::kActive), three(S::kActive, S::kPreempting, S::kWaitingForResult),
     two(S::kActive, S::kWaitingForResult), two(S::kActive, S::kWaitingForResult),
     two(S::kPending, S::kWaitingForResult), two(S::kActive, S::kPreempting), two(S::kPending, S::kRecalling),
     two(S::kPending, S::kWaitingForResult)},
    {kNone, one(S::kActive), three(S::kActive, S::kPreempting, S::kWaitingForResult),
     two(S::kActive, S::kWaitingForResult), two(S::kActive, S::kWaitingForResult), one(S::kWaitingForResult),
     two(S::kActive, S::kPreempting), one(S::kRecalling), two(S::kRecalling, S::kWaitingForResult)},
    {kNever, kNone, two(S::kPreempting, S::kWaitingForResult), one(S::kWaitingForResult), one(S::kWaitingForResult),
     kNever, one(S::kPreempting), kNever, kNever},
    {kNever, kNone, kNone, kNone, kNone, kNone, kNever, kNever, kNone},
    {kNone, kNone, two(S::kPreempting, S::kWaitingForResult), two(S::kPreempting, S::kWaitingForResult),
     two(S::kPreempting, S::kWaitingForResult), one(S::kWaitingForResult), one(S::kPreempting), one(S::kRecalling),
     two(S::kRecalling, S::kWaitingForResult)},
    {kNever, kNever, two(S::kPreempting, S::kWaitingForResult), two(S::kPreempting, S::kWaitingForResult),
     two(S::kPreempting, S::kWaitingForResult), one(S::kWaitingForResult), one(S::kPreempting), kNone,
     one(S::kWaitingForResult)},
    {kNever, kNever, one(S::kWaitingForResult), one(S::kWaitingForResult), one(S::kWaitingForResult), kNever, kNone,
     kNever, kNever},
};

} // namespace

int GoalProgress::steps(State from, unsigned status, State (&to)[kMostSteps])
{
    if (from == kDone || status >= kStatuses)
    {
        return from == kDone ? 0 : -1;
    }
    const Path &path = kPaths[from][status];
    for (int i = 0; i < path.count; ++i)
    {
        to[i] = path.to[i];
    }
    return path.count;
}

} // namespace roscfe
