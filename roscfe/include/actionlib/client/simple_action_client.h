// actionlib::SimpleActionClient: one goal at a time, and what the server says of it.
#ifndef ROSCFE_ACTIONLIB_CLIENT_SIMPLE_ACTION_CLIENT_H
#define ROSCFE_ACTIONLIB_CLIENT_SIMPLE_ACTION_CLIENT_H

#include <boost/thread/recursive_mutex.hpp>

#include <bitset> // these three come with ROS's header, and nodes rely on it
#include <deque>
#include <optional>

#include <string>

#include <boost/function.hpp>
#include <boost/make_shared.hpp>

#if defined(ROSCFE_PROFILE_HOST) // these three come with ROS's header, and nodes rely on it
#include "boost/thread/condition_variable.hpp"
#include "boost/thread/shared_mutex.hpp"
#include "boost/thread/thread_only.hpp"
#endif

#include "actionlib/client/action_client.h"
#include "actionlib/client/simple_goal_state.h"
#include "ros/ros.h"
#include "roscfe/waiting.h"

namespace actionlib
{

template <class ActionSpec>
class SimpleActionClient
{
  public:
    ACTION_DEFINITION(ActionSpec)
    typedef boost::function<void(const SimpleClientGoalState &, const ResultConstPtr &)> SimpleDoneCallback;
    typedef boost::function<void()>                                                      SimpleActiveCallback;
    typedef boost::function<void(const FeedbackConstPtr &)>                              SimpleFeedbackCallback;

    SimpleActionClient(const std::string &name, bool spin_thread = true)
        : SimpleActionClient(ros::NodeHandle(), name, spin_thread)
    {
    }
    // The client's callbacks run in a thread of its own, or, in a node that is not for the host, whenever the node waits.
    SimpleActionClient(ros::NodeHandle node, const std::string &name, bool spin_thread = true)
        : client_(node, name, spin_thread ? &queue_ : nullptr)
    {
        if (spin_thread)
        {
            thread_.start(&queue_);
        }
    }
    ~SimpleActionClient() { thread_.stop(); }
    SimpleActionClient(const SimpleActionClient &) = delete;
    SimpleActionClient &operator=(const SimpleActionClient &) = delete;

    // Whether a server takes goals, within a time; 0 waits for ever.
    bool waitForServer(const ros::Duration &timeout = ros::Duration(0, 0))
    {
        return client_.waitForActionServerToStart(timeout);
    }
    bool isServerConnected() { return client_.isServerConnected(); }

    void sendGoal(const Goal &goal, SimpleDoneCallback done = SimpleDoneCallback(),
                  SimpleActiveCallback   active   = SimpleActiveCallback(),
                  SimpleFeedbackCallback feedback = SimpleFeedbackCallback())
    {
        goal_.reset();
        on_done_     = done;
        on_active_   = active;
        on_feedback_ = feedback;
        told_active_ = false;
        goal_        = client_.sendGoal(goal, [this](GoalHandle handle) { change(handle); },
                                        [this](GoalHandle handle, const FeedbackConstPtr &news) {
                                            if (handle == goal_ && on_feedback_)
                                            {
                                                on_feedback_(news);
                                            }
                                        });
    }

    SimpleClientGoalState sendGoalAndWait(const Goal &goal, const ros::Duration &execute = ros::Duration(0, 0),
                                          const ros::Duration &preempt = ros::Duration(0, 0))
    {
        sendGoal(goal);
        if (!waitForResult(execute))
        {
            cancelGoal();
            waitForResult(preempt);
        }
        return getState();
    }

    bool waitForResult(const ros::Duration &timeout = ros::Duration(0, 0))
    {
        if (!has_goal("waitForGoalToFinish"))
        {
            return false;
        }
        return roscfe::wait_until(
            timeout, [this]() { return !goal_.isExpired() && goal_.getCommState() == CommState::DONE; });
    }

    ResultConstPtr getResult() const
    {
        const ResultConstPtr result = has_goal("getResult") ? goal_.getResult() : ResultConstPtr();
        return result ? result : ResultConstPtr(boost::make_shared<Result>());
    }

    SimpleClientGoalState getState() const
    {
        typedef SimpleClientGoalState Simple;
        if (!has_goal("getState"))
        {
            return Simple(Simple::LOST);
        }
        switch (goal_.getCommState().state_)
        {
            case CommState::WAITING_FOR_GOAL_ACK:
            case CommState::PENDING:
            case CommState::RECALLING:
                return Simple(Simple::PENDING);
            case CommState::ACTIVE:
            case CommState::PREEMPTING:
                return Simple(Simple::ACTIVE);
            case CommState::WAITING_FOR_RESULT:
            case CommState::WAITING_FOR_CANCEL_ACK:
                return Simple(told_active_ ? Simple::ACTIVE : Simple::PENDING);
            default:
                break;
        }
        const TerminalState end = goal_.getTerminalState();
        switch (end.state_)
        {
            case TerminalState::RECALLED:
                return Simple(Simple::RECALLED, end.text_);
            case TerminalState::REJECTED:
                return Simple(Simple::REJECTED, end.text_);
            case TerminalState::PREEMPTED:
                return Simple(Simple::PREEMPTED, end.text_);
            case TerminalState::ABORTED:
                return Simple(Simple::ABORTED, end.text_);
            case TerminalState::SUCCEEDED:
                return Simple(Simple::SUCCEEDED, end.text_);
            default:
                return Simple(Simple::LOST, end.text_);
        }
    }

    void cancelAllGoals() { client_.cancelAllGoals(); }
    void cancelGoalsAtAndBeforeTime(const ros::Time &time) { client_.cancelGoalsAtAndBeforeTime(time); }
    void cancelGoal()
    {
        if (has_goal("cancelGoal"))
        {
            goal_.cancel();
        }
    }
    void stopTrackingGoal()
    {
        has_goal("stopTrackingGoal");
        goal_.reset();
    }

  private:
    typedef ClientGoalHandle<ActionSpec> GoalHandle;

    bool has_goal(const char *asked) const
    {
        if (goal_.isExpired())
        {
            ROS_ERROR_NAMED("actionlib",
                            "Trying to %s() when no goal is running. You are incorrectly using SimpleActionClient",
                            asked);
        }
        return !goal_.isExpired();
    }

    void change(GoalHandle handle)
    {
        if (handle != goal_)
        {
            return;
        }
        const CommState state = handle.getCommState();
        if ((state == CommState::ACTIVE || state == CommState::PREEMPTING) && !told_active_)
        {
            told_active_ = true;
            if (on_active_)
            {
                on_active_();
            }
        }
        if (state == CommState::DONE && on_done_)
        {
            const SimpleDoneCallback done = on_done_; // it may send the next goal
            done(getState(), handle.getResult());
        }
    }

    ros::CallbackQueue       queue_;
    ActionClient<ActionSpec> client_;
    roscfe::OwnThread        thread_;
    GoalHandle               goal_;
    SimpleDoneCallback       on_done_;
    SimpleActiveCallback     on_active_;
    SimpleFeedbackCallback   on_feedback_;
    bool                     told_active_ = false;
};

} // namespace actionlib

#endif
