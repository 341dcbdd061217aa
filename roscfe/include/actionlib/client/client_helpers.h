// Goals that a client has sent, and the handles that it gives out for them (http://wiki.ros.org/actionlib).
#ifndef ROSCFE_ACTIONLIB_CLIENT_CLIENT_HELPERS_H
#define ROSCFE_ACTIONLIB_CLIENT_CLIENT_HELPERS_H

#include <cstdint>
#include <string>
#include <vector>

#include <boost/function.hpp>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <boost/weak_ptr.hpp>

#include "actionlib/action_definition.h"
#include "actionlib/client/comm_state.h"
#include "actionlib/client/terminal_state.h"
#include "actionlib_msgs/GoalID.h"
#include "actionlib_msgs/GoalStatusArray.h"
#include "ros/console.h"
#include "ros/publisher.h"
#include "roscfe/goal_progress.h"

namespace actionlib
{

template <class ActionSpec>
class ActionClient;
template <class ActionSpec>
class ClientGoalHandle;

} // namespace actionlib

namespace roscfe
{

// A goal that was sent: what its handles share.
template <class ActionSpec>
struct SentGoal
{
    ACTION_DEFINITION(ActionSpec)
    typedef actionlib::ClientGoalHandle<ActionSpec>                     Handle;
    typedef boost::function<void(Handle)>                               TransitionCallback;
    typedef boost::function<void(Handle, const FeedbackConstPtr &)> FeedbackCallback;

    boost::shared_ptr<ActionGoal>         message;
    GoalProgress::State                   state = GoalProgress::kWaitingForAck;
    actionlib_msgs::GoalStatus            status;
    ActionResultConstPtr                  result;
    TransitionCallback                    on_transition;
    FeedbackCallback                      on_feedback;
    actionlib::ActionClient<ActionSpec> *client = nullptr; // none when it is gone
};

} // namespace roscfe

namespace actionlib
{

// A goal as long as somebody wants to know of it: it is forgotten with its last handle.
template <class ActionSpec>
class ClientGoalHandle
{
  public:
    ACTION_DEFINITION(ActionSpec)

    ClientGoalHandle() = default;

    void reset() { goal_.reset(); }
    bool isExpired() const { return !goal_; }

    CommState getCommState() const
    {
        return CommState(has("getCommState") ? static_cast<CommState::StateEnum>(goal_->state) : CommState::DONE);
    }

    TerminalState getTerminalState() const
    {
        typedef actionlib_msgs::GoalStatus Status;
        if (!has("getTerminalState"))
        {
            return TerminalState(TerminalState::LOST);
        }
        if (goal_->state != roscfe::GoalProgress::kDone)
        {
            ROS_WARN_NAMED("actionlib", "Asking for the terminal state when we're in [%s]",
                           getCommState().toString().c_str());
        }
        const std::string text(goal_->status.text.c_str());
        switch (goal_->status.status)
        {
            case Status::PREEMPTED:
                return TerminalState(TerminalState::PREEMPTED, text);
            case Status::SUCCEEDED:
                return TerminalState(TerminalState::SUCCEEDED, text);
            case Status::ABORTED:
                return TerminalState(TerminalState::ABORTED, text);
            case Status::REJECTED:
                return TerminalState(TerminalState::REJECTED, text);
            case Status::RECALLED:
                return TerminalState(TerminalState::RECALLED, text);
            case Status::LOST:
                return TerminalState(TerminalState::LOST, text);
            default:
                ROS_ERROR_NAMED("actionlib", "Asking for terminal state, but latest goal status is %u",
                                static_cast<unsigned>(goal_->status.status));
                return TerminalState(TerminalState::LOST, text);
        }
    }

    // The server's result; none when there is none.
    ResultConstPtr getResult() const
    {
        const bool there = has("getResult") && goal_->result;
        return there ? roscfe::part_of(goal_->result, goal_->result->result) : ResultConstPtr();
    }

    // Send the goal again, with the same id.
    void resend()
    {
        if (has("resend"))
        {
            goal_->client->goal_publisher_.publish(*goal_->message);
        }
    }

    // Ask the server to end it; nothing happens when it has ended, or is being ended.
    void cancel()
    {
        typedef roscfe::GoalProgress State;
        if (!has("cancel"))
        {
            return;
        }
        if (goal_->state != State::kWaitingForAck && goal_->state != State::kPending &&
            goal_->state != State::kActive && goal_->state != State::kWaitingForCancelAck)
        {
            ROS_DEBUG_NAMED("actionlib", "Got a cancel() request while in state [%s], so ignoring it",
                            getCommState().toString().c_str());
            return;
        }
        actionlib_msgs::GoalID id;
        id.stamp = ros::Time(0, 0);
        id.id    = goal_->message->goal_id.id;
        goal_->client->cancel_publisher_.publish(id);
        move(State::kWaitingForCancelAck);
    }

    bool operator==(const ClientGoalHandle &other) const { return goal_ == other.goal_; }
    bool operator!=(const ClientGoalHandle &other) const { return goal_ != other.goal_; }

  private:
    friend class ActionClient<ActionSpec>;
    typedef roscfe::SentGoal<ActionSpec> Sent;

    explicit ClientGoalHandle(const boost::shared_ptr<Sent> &goal) : goal_(goal) {}

    // Whether there is a goal, and a client that can be asked.
    bool has(const char *asked) const
    {
        if (!goal_)
        {
            ROS_ERROR_NAMED("actionlib",
                            "Trying to %s on an inactive ClientGoalHandle. You are incorrectly using a "
                            "ClientGoalHandle",
                            asked);
            return false;
        }
        if (goal_->client == nullptr)
        {
            ROS_ERROR_NAMED("actionlib",
                            "This action client associated with the goal handle has already been destructed. Ignoring "
                            "this %s() call",
                            asked);
            return false;
        }
        return true;
    }

    bool is_about(const actionlib_msgs::GoalStatus &status) const
    {
        return status.goal_id.id == goal_->message->goal_id.id;
    }

    void hear(const actionlib_msgs::GoalStatusArray &all)
    {
        if (goal_->state == roscfe::GoalProgress::kDone)
        {
            return;
        }
        for (const auto &each : all.status_list)
        {
            if (is_about(each))
            {
                goal_->status = each;
                advance(each.status);
                return;
            }
        }
        // A server that has forgotten the goal.
        if (goal_->state != roscfe::GoalProgress::kWaitingForAck &&
            goal_->state != roscfe::GoalProgress::kWaitingForResult)
        {
            ROS_WARN_NAMED("actionlib", "Transitioning goal to LOST");
            goal_->status.status = actionlib_msgs::GoalStatus::LOST;
            move(roscfe::GoalProgress::kDone);
        }
    }

    void hear(const ActionFeedbackConstPtr &feedback)
    {
        if (is_about(feedback->status) && goal_->on_feedback)
        {
            goal_->on_feedback(*this, roscfe::part_of(feedback, feedback->feedback));
        }
    }

    void hear(const ActionResultConstPtr &result)
    {
        if (!is_about(result->status))
        {
            return;
        }
        goal_->status = result->status;
        goal_->result = result;
        if (goal_->state == roscfe::GoalProgress::kDone)
        {
            ROS_ERROR_NAMED("actionlib", "Got a result when we were already in the DONE state");
            return;
        }
        advance(result->status.status);
        move(roscfe::GoalProgress::kDone);
    }

    void advance(unsigned status)
    {
        roscfe::GoalProgress::State to[roscfe::GoalProgress::kMostSteps];
        const int                   count = roscfe::GoalProgress::steps(goal_->state, status, to);
        if (count < 0)
        {
            ROS_ERROR_NAMED("actionlib", "A server's goal status %u makes no sense in state %s", status,
                            getCommState().toString().c_str());
        }
        for (int i = 0; i < count; ++i)
        {
            move(to[i]);
        }
    }

    void move(roscfe::GoalProgress::State to)
    {
        goal_->state = to;
        if (goal_->on_transition)
        {
            goal_->on_transition(*this);
        }
    }

    boost::shared_ptr<Sent> goal_;
};

} // namespace actionlib

#endif
