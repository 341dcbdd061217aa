// actionlib::SimpleActionClient: one goal at a time, and what the server says of it.
#ifndef ROSCFE_ACTIONLIB_CLIENT_SIMPLE_ACTION_CLIENT_H
#define ROSCFE_ACTIONLIB_CLIENT_SIMPLE_ACTION_CLIENT_H

#include <string>

#include "actionlib/action_definition.h"
#include "actionlib/client/simple_goal_state.h"
#include "actionlib/goal_id_generator.h"
#include "actionlib_msgs/GoalID.h"
#include "actionlib_msgs/GoalStatusArray.h"
#include "ros/ros.h"
#include "roscfe/goal_progress.h"
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
    // With a thread of its own in ROS, the client's callbacks run here whenever the node waits.
    SimpleActionClient(ros::NodeHandle node, const std::string &name, bool spin_thread = true) : node_(node, name)
    {
        if (spin_thread)
        {
            node_.setCallbackQueue(&queue_);
            waiting_.start(&queue_);
        }
        goal_publisher_   = node_.template advertise<ActionGoal>("goal", 10);
        cancel_publisher_ = node_.template advertise<actionlib_msgs::GoalID>("cancel", 10);
        status_subscriber_ = node_.template subscribe<actionlib_msgs::GoalStatusArray>(
            "status", 10, [this](const actionlib_msgs::GoalStatusArray::ConstPtr &all) { hear(*all); });
        feedback_subscriber_ = node_.template subscribe<ActionFeedback>(
            "feedback", 10, [this](const ActionFeedbackConstPtr &feedback) { hear(feedback); });
        result_subscriber_ = node_.template subscribe<ActionResult>(
            "result", 10, [this](const ActionResultConstPtr &result) { hear(result); });
    }
    SimpleActionClient(const SimpleActionClient &) = delete;
    SimpleActionClient &operator=(const SimpleActionClient &) = delete;

    // Whether a server takes goals, within a time; 0 waits for ever.
    bool waitForServer(const ros::Duration &timeout = ros::Duration(0, 0))
    {
        return wait(timeout, [this]() { return isServerConnected(); });
    }
    bool isServerConnected()
    {
        return has_status_ && goal_publisher_.getNumSubscribers() > 0 && cancel_publisher_.getNumSubscribers() > 0;
    }

    void sendGoal(const Goal &goal, SimpleDoneCallback done = SimpleDoneCallback(),
                  SimpleActiveCallback   active   = SimpleActiveCallback(),
                  SimpleFeedbackCallback feedback = SimpleFeedbackCallback())
    {
        on_done_     = done;
        on_active_   = active;
        on_feedback_ = feedback;
        state_       = State::kWaitingForAck;
        has_goal_    = true;
        told_active_ = false;
        status_      = actionlib_msgs::GoalStatus();
        result_.reset();
        ActionGoal message;
        message.header.stamp = ros::Time::now();
        message.goal_id      = ids_.generateID();
        message.goal         = goal;
        goal_id_             = message.goal_id;
        goal_publisher_.publish(message);
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
        if (!has_goal_)
        {
            ROS_ERROR_NAMED("actionlib", "Trying to waitForGoalToFinish() when no goal is running. You are incorrectly "
                                         "using SimpleActionClient");
            return false;
        }
        return wait(timeout, [this]() { return state_ == State::kDone; });
    }

    ResultConstPtr getResult() const
    {
        return result_ ? roscfe::part_of(result_, result_->result) : boost::make_shared<Result>();
    }

    SimpleClientGoalState getState() const
    {
        typedef SimpleClientGoalState        Simple;
        typedef actionlib_msgs::GoalStatus Status;
        const std::string text(status_.text.c_str());
        if (!has_goal_)
        {
            return Simple(Simple::LOST);
        }
        switch (state_)
        {
            case State::kWaitingForAck:
            case State::kPending:
            case State::kRecalling:
                return Simple(Simple::PENDING);
            case State::kActive:
            case State::kPreempting:
                return Simple(Simple::ACTIVE);
            case State::kWaitingForResult:
            case State::kWaitingForCancelAck:
                return Simple(told_active_ ? Simple::ACTIVE : Simple::PENDING);
            default:
                break;
        }
        switch (status_.status)
        {
            case Status::RECALLED:
                return Simple(Simple::RECALLED, text);
            case Status::REJECTED:
                return Simple(Simple::REJECTED, text);
            case Status::PREEMPTED:
                return Simple(Simple::PREEMPTED, text);
            case Status::ABORTED:
                return Simple(Simple::ABORTED, text);
            case Status::SUCCEEDED:
                return Simple(Simple::SUCCEEDED, text);
            default:
                return Simple(Simple::LOST, text);
        }
    }

    void cancelAllGoals() { cancel_publisher_.publish(actionlib_msgs::GoalID()); }
    void cancelGoalsAtAndBeforeTime(const ros::Time &time)
    {
        actionlib_msgs::GoalID id;
        id.stamp = time;
        cancel_publisher_.publish(id);
    }
    void cancelGoal()
    {
        if (!has_goal_)
        {
            ROS_ERROR_NAMED("actionlib", "Trying to cancelGoal() when no goal is running. You are incorrectly using "
                                         "SimpleActionClient");
            return;
        }
        if (state_ == State::kWaitingForAck || state_ == State::kPending || state_ == State::kActive ||
            state_ == State::kWaitingForCancelAck)
        {
            actionlib_msgs::GoalID id;
            id.stamp = ros::Time(0, 0);
            id.id    = goal_id_.id;
            cancel_publisher_.publish(id);
            state_ = State::kWaitingForCancelAck;
        }
    }
    void stopTrackingGoal() { has_goal_ = false; }

  private:
    typedef roscfe::GoalProgress State;

    template <class F>
    bool wait(const ros::Duration &timeout, F there)
    {
        const std::int64_t until =
            static_cast<std::int64_t>(ros::Time::now().toNSec()) + (timeout.isZero() ? 0 : timeout.toNSec());
        while (!there())
        {
            if (!ros::ok())
            {
                return false;
            }
            const std::int64_t look = static_cast<std::int64_t>(ros::Time::now().toNSec()) + 100000000;
            if (!timeout.isZero() && look >= until)
            {
                if (!roscfe::wait_for_news(until))
                {
                    return there();
                }
            }
            else
            {
                roscfe::wait_for_news(look);
            }
        }
        return true;
    }

    void hear(const actionlib_msgs::GoalStatusArray &all)
    {
        has_status_ = true;
        if (!has_goal_ || state_ == State::kDone)
        {
            return;
        }
        for (const auto &each : all.status_list)
        {
            if (each.goal_id.id == goal_id_.id)
            {
                advance(each);
                return;
            }
        }
        // A server that has forgotten the goal.
        if (state_ != State::kWaitingForAck && state_ != State::kWaitingForResult)
        {
            status_.status = actionlib_msgs::GoalStatus::LOST;
            move(State::kDone);
        }
    }

    void hear(const ActionFeedbackConstPtr &feedback)
    {
        if (has_goal_ && feedback->status.goal_id.id == goal_id_.id && on_feedback_)
        {
            on_feedback_(roscfe::part_of(feedback, feedback->feedback));
        }
    }

    void hear(const ActionResultConstPtr &result)
    {
        if (!has_goal_ || state_ == State::kDone || result->status.goal_id.id != goal_id_.id)
        {
            return;
        }
        result_ = result;
        advance(result->status);
        status_ = result->status;
        move(State::kDone);
    }

    void advance(const actionlib_msgs::GoalStatus &status)
    {
        if (state_ != State::kWaitingForResult)
        {
            status_ = status;
        }
        State::State to[State::kMostSteps];
        const int    count = State::steps(state_, status.status, to);
        if (count < 0)
        {
            ROS_ERROR_NAMED("actionlib", "A server's goal status %u makes no sense in state %d",
                            static_cast<unsigned>(status.status), static_cast<int>(state_));
        }
        for (int i = 0; i < count; ++i)
        {
            move(to[i]);
        }
    }

    void move(State::State to)
    {
        state_ = to;
        if (to == State::kActive && !told_active_)
        {
            told_active_ = true;
            if (on_active_)
            {
                on_active_();
            }
        }
        if (to == State::kDone && on_done_)
        {
            const SimpleDoneCallback done = on_done_; // it may send the next goal
            done(getState(), getResult());
        }
    }

    ros::NodeHandle            node_;
    ros::CallbackQueue         queue_;
    roscfe::WhileWaiting       waiting_;
    GoalIDGenerator            ids_;
    ros::Publisher             goal_publisher_;
    ros::Publisher             cancel_publisher_;
    ros::Subscriber            status_subscriber_;
    ros::Subscriber            feedback_subscriber_;
    ros::Subscriber            result_subscriber_;
    SimpleDoneCallback         on_done_;
    SimpleActiveCallback       on_active_;
    SimpleFeedbackCallback     on_feedback_;
    State::State               state_ = State::kDone;
    actionlib_msgs::GoalID     goal_id_;
    actionlib_msgs::GoalStatus status_;
    ActionResultConstPtr       result_;
    bool                       has_goal_    = false;
    bool                       has_status_  = false;
    bool                       told_active_ = false;
};

} // namespace actionlib

#endif
