// actionlib::ActionServer: goals that come, what becomes of them, and who is told (http://wiki.ros.org/actionlib).
#ifndef ROSCFE_ACTIONLIB_SERVER_ACTION_SERVER_H
#define ROSCFE_ACTIONLIB_SERVER_ACTION_SERVER_H

#include <list>
#include <string>

#include "actionlib/action_definition.h"
#include "actionlib/goal_id_generator.h"
#include "actionlib_msgs/GoalID.h"
#include "actionlib_msgs/GoalStatus.h"
#include "actionlib_msgs/GoalStatusArray.h"
#include "ros/ros.h"

namespace actionlib
{

template <class ActionSpec>
class ActionServer;

// A goal of a server, and what happens to it.
template <class ActionSpec>
class ServerGoalHandle
{
  public:
    ACTION_DEFINITION(ActionSpec)
    typedef actionlib_msgs::GoalStatus Status;

    ServerGoalHandle() = default;

    bool                       isValid() const { return tracker_ != nullptr; }
    GoalConstPtr               getGoal() const
    {
        return tracker_ ? roscfe::part_of(tracker_->goal, tracker_->goal->goal) : GoalConstPtr();
    }
    actionlib_msgs::GoalID     getGoalID() const { return tracker_ ? tracker_->status.goal_id : actionlib_msgs::GoalID(); }
    actionlib_msgs::GoalStatus getGoalStatus() const
    {
        return tracker_ ? tracker_->status : actionlib_msgs::GoalStatus();
    }

    void setAccepted(const std::string &text = std::string())
    {
        move(Status::PENDING, Status::ACTIVE, Status::RECALLING, Status::PREEMPTING, text) && publish_status();
    }
    void setRejected(const Result &result = Result(), const std::string &text = std::string())
    {
        move(Status::PENDING, Status::REJECTED, Status::RECALLING, Status::REJECTED, text) && publish_result(result);
    }
    void setAborted(const Result &result = Result(), const std::string &text = std::string())
    {
        move(Status::ACTIVE, Status::ABORTED, Status::PREEMPTING, Status::ABORTED, text) && publish_result(result);
    }
    void setSucceeded(const Result &result = Result(), const std::string &text = std::string())
    {
        move(Status::ACTIVE, Status::SUCCEEDED, Status::PREEMPTING, Status::SUCCEEDED, text) && publish_result(result);
    }
    void setCanceled(const Result &result = Result(), const std::string &text = std::string())
    {
        const bool waited = is(Status::PENDING) || is(Status::RECALLING);
        (waited ? move(Status::PENDING, Status::RECALLED, Status::RECALLING, Status::RECALLED, text)
                : move(Status::ACTIVE, Status::PREEMPTED, Status::PREEMPTING, Status::PREEMPTED, text)) &&
            publish_result(result);
    }

    // A client wants it to end; whether it can still be ended.
    bool setCancelRequested()
    {
        const std::string text = has_goal() ? tracker_->status.text.c_str() : "";
        return move(Status::PENDING, Status::RECALLING, Status::ACTIVE, Status::PREEMPTING, text) && publish_status();
    }

    void publishFeedback(const Feedback &feedback)
    {
        if (has_goal())
        {
            server_->publishFeedback(tracker_->status, feedback);
        }
    }

    bool operator==(const ServerGoalHandle &other) const { return tracker_ == other.tracker_; }
    bool operator!=(const ServerGoalHandle &other) const { return tracker_ != other.tracker_; }

  private:
    friend class ActionServer<ActionSpec>;
    typedef typename ActionServer<ActionSpec>::Tracker Tracker;

    // What copies of a handle share; when the last one is gone the goal is forgotten after a while.
    struct Hold
    {
        explicit Hold(Tracker *of) : tracker(of) { ++tracker->holds; }
        ~Hold()
        {
            if (--tracker->holds == 0)
            {
                tracker->released = ros::Time::now();
            }
        }
        Hold(const Hold &) = delete;
        Hold &operator=(const Hold &) = delete;
        Tracker *tracker;
    };

    ServerGoalHandle(ActionServer<ActionSpec> *server, Tracker *tracker)
        : server_(server), tracker_(tracker), hold_(boost::make_shared<Hold>(tracker))
    {
    }

    bool has_goal() const
    {
        if (tracker_ == nullptr)
        {
            ROS_ERROR_NAMED("actionlib", "A goal handle is used that has no goal");
        }
        return tracker_ != nullptr;
    }
    bool is(unsigned status) const { return tracker_ != nullptr && tracker_->status.status == status; }

    bool move(unsigned from, unsigned to, unsigned or_from, unsigned or_to, const std::string &text)
    {
        if (!has_goal())
        {
            return false;
        }
        if (!is(from) && !is(or_from))
        {
            ROS_ERROR_NAMED("actionlib", "A goal of status %u cannot get the status %u",
                            static_cast<unsigned>(tracker_->status.status), to);
            return false;
        }
        tracker_->status.status = static_cast<std::uint8_t>(is(from) ? to : or_to);
        tracker_->status.text   = text.c_str();
        return true;
    }
    bool publish_status()
    {
        server_->publishStatus();
        return true;
    }
    bool publish_result(const Result &result)
    {
        server_->publishResult(tracker_->status, result);
        return true;
    }

    ActionServer<ActionSpec> *server_  = nullptr;
    Tracker *                 tracker_ = nullptr;
    boost::shared_ptr<Hold>   hold_;
};

template <class ActionSpec>
class ActionServer
{
  public:
    ACTION_DEFINITION(ActionSpec)
    typedef ServerGoalHandle<ActionSpec>         GoalHandle;
    typedef boost::function<void(GoalHandle)> Callback;

    struct Tracker
    {
        ActionGoalConstPtr         goal;
        actionlib_msgs::GoalStatus status;
        ros::Time                  released; // when the last handle was; zero while there is one
        unsigned                   holds = 0;
    };

    ActionServer(ros::NodeHandle node, const std::string &name, bool auto_start)
        : ActionServer(node, name, Callback(), Callback(), auto_start)
    {
    }
    ActionServer(ros::NodeHandle node, const std::string &name, const Callback &goal, bool auto_start)
        : ActionServer(node, name, goal, Callback(), auto_start)
    {
    }
    ActionServer(ros::NodeHandle node, const std::string &name, const Callback &goal, const Callback &cancel,
                 bool auto_start)
        : node_(node, name), on_goal_(goal), on_cancel_(cancel)
    {
        if (auto_start)
        {
            start();
        }
    }
    ActionServer(const ActionServer &) = delete;
    ActionServer &operator=(const ActionServer &) = delete;

    void registerGoalCallback(const Callback &callback) { on_goal_ = callback; }
    void registerCancelCallback(const Callback &callback) { on_cancel_ = callback; }

    void start()
    {
        if (started_)
        {
            return;
        }
        started_ = true;
        result_publisher_   = node_.advertise<ActionResult>("result", 50);
        feedback_publisher_ = node_.advertise<ActionFeedback>("feedback", 50);
        status_publisher_   = node_.advertise<actionlib_msgs::GoalStatusArray>("status", 50, true);
        double frequency = 5.0, timeout = 5.0;
        std::string found;
        if (node_.getParam("status_frequency", frequency) || (node_.searchParam("actionlib_status_frequency", found) &&
                                                              ros::param::get(found, frequency)))
        {
        }
        node_.param("status_list_timeout", timeout, 5.0);
        status_timeout_ = ros::Duration(timeout);
        if (frequency > 0)
        {
            timer_ = node_.createTimer(ros::Duration(1.0 / frequency), [this](const ros::TimerEvent &) { publishStatus(); });
        }
        goal_subscriber_ = node_.subscribe<ActionGoal>("goal", 50, [this](const ActionGoalConstPtr &goal) { take(goal); });
        cancel_subscriber_ = node_.subscribe<actionlib_msgs::GoalID>(
            "cancel", 50, [this](const actionlib_msgs::GoalID::ConstPtr &id) { cancel(*id); });
        publishStatus();
    }

    void publishStatus()
    {
        actionlib_msgs::GoalStatusArray all;
        all.header.stamp = ros::Time::now();
        for (auto each = trackers_.begin(); each != trackers_.end();)
        {
            all.status_list.push_back(each->status);
            const bool forgotten = !each->released.isZero() && each->released + status_timeout_ < all.header.stamp;
            each                 = forgotten ? trackers_.erase(each) : std::next(each);
        }
        status_publisher_.publish(all);
    }

    void publishResult(const actionlib_msgs::GoalStatus &status, const Result &result)
    {
        ActionResult message;
        message.header.stamp = ros::Time::now();
        message.status       = status;
        message.result       = result;
        result_publisher_.publish(message);
        publishStatus();
    }

    void publishFeedback(const actionlib_msgs::GoalStatus &status, const Feedback &feedback)
    {
        ActionFeedback message;
        message.header.stamp = ros::Time::now();
        message.status       = status;
        message.feedback     = feedback;
        feedback_publisher_.publish(message);
    }

  private:
    typedef actionlib_msgs::GoalStatus Status;

    void take(const ActionGoalConstPtr &goal)
    {
        for (Tracker &each : trackers_)
        {
            if (each.status.goal_id.id == goal->goal_id.id)
            {
                // Its cancellation came first.
                if (each.status.status == Status::RECALLING)
                {
                    each.status.status = Status::RECALLED;
                    publishResult(each.status, Result());
                }
                if (each.holds == 0)
                {
                    each.released = goal->goal_id.stamp;
                }
                return;
            }
        }
        trackers_.emplace_back();
        Tracker &tracker       = trackers_.back();
        tracker.goal           = goal;
        tracker.status.goal_id = goal->goal_id;
        tracker.status.status  = Status::PENDING;
        if (goal->goal_id.id.empty())
        {
            tracker.status.goal_id = ids_.generateID();
        }
        if (tracker.status.goal_id.stamp.isZero())
        {
            tracker.status.goal_id.stamp = ros::Time::now();
        }
        GoalHandle handle(this, &tracker);
        if (!goal->goal_id.stamp.isZero() && goal->goal_id.stamp <= last_cancel_)
        {
            handle.setCanceled(Result(), "This goal handle was canceled by the action server because its timestamp is "
                                         "before the timestamp of the last cancel request");
        }
        else if (on_goal_)
        {
            on_goal_(handle);
        }
    }

    void cancel(const actionlib_msgs::GoalID &id)
    {
        const bool all   = id.id.empty() && id.stamp.isZero();
        bool       known = false;
        for (Tracker &each : trackers_)
        {
            const bool meant = each.status.goal_id.id == id.id;
            known            = known || meant;
            if (!all && !meant && (id.stamp.isZero() || each.status.goal_id.stamp > id.stamp))
            {
                continue;
            }
            const unsigned now = each.status.status;
            if (now != Status::PENDING && now != Status::ACTIVE)
            {
                continue;
            }
            GoalHandle handle(this, &each);
            if (handle.setCancelRequested() && on_cancel_)
            {
                on_cancel_(handle);
            }
        }
        if (!id.id.empty() && !known) // it may be on its way
        {
            trackers_.emplace_back();
            trackers_.back().status.goal_id = id;
            trackers_.back().status.status  = Status::RECALLING;
            trackers_.back().released       = id.stamp.isZero() ? ros::Time::now() : id.stamp;
        }
        if (id.stamp > last_cancel_)
        {
            last_cancel_ = id.stamp;
        }
    }

    ros::NodeHandle    node_;
    Callback           on_goal_;
    Callback           on_cancel_;
    GoalIDGenerator    ids_;
    std::list<Tracker> trackers_;
    ros::Time          last_cancel_;
    ros::Duration      status_timeout_;
    bool               started_ = false;
    ros::Publisher     result_publisher_;
    ros::Publisher     feedback_publisher_;
    ros::Publisher     status_publisher_;
    ros::Subscriber    goal_subscriber_;
    ros::Subscriber    cancel_subscriber_;
    ros::Timer         timer_;
};

} // namespace actionlib

#endif
