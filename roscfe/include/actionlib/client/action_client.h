// actionlib::ActionClient: any number of goals at a time, each with a handle (http://wiki.ros.org/actionlib).
#ifndef ROSCFE_ACTIONLIB_CLIENT_ACTION_CLIENT_H
#define ROSCFE_ACTIONLIB_CLIENT_ACTION_CLIENT_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "actionlib/client/client_helpers.h"
#include "actionlib/goal_id_generator.h"
#include "ros/ros.h"
#include "roscfe/waiting.h"

namespace actionlib
{

template <class ActionSpec>
class ActionClient
{
  public:
    ACTION_DEFINITION(ActionSpec)
    typedef ClientGoalHandle<ActionSpec>                              GoalHandle;
    typedef typename roscfe::SentGoal<ActionSpec>::TransitionCallback TransitionCallback;
    typedef typename roscfe::SentGoal<ActionSpec>::FeedbackCallback   FeedbackCallback;

    explicit ActionClient(const std::string &name, ros::CallbackQueueInterface *queue = nullptr)
        : ActionClient(ros::NodeHandle(), name, queue)
    {
    }
    ActionClient(const ros::NodeHandle &node, const std::string &name, ros::CallbackQueueInterface *queue = nullptr)
        : node_(node, name)
    {
        if (queue != nullptr)
        {
            node_.setCallbackQueue(queue);
        }
        const std::uint32_t to_send = queue_size("actionlib_client_pub_queue_size");
        const std::uint32_t to_hear = queue_size("actionlib_client_sub_queue_size");
        status_subscriber_          = node_.template subscribe<actionlib_msgs::GoalStatusArray>(
            "status", to_hear, [this](const actionlib_msgs::GoalStatusArray::ConstPtr &all) {
                has_status_ = true;
                tell(*all);
            });
        feedback_subscriber_ = node_.template subscribe<ActionFeedback>(
            "feedback", to_hear, [this](const ActionFeedbackConstPtr &feedback) { tell(feedback); });
        result_subscriber_ = node_.template subscribe<ActionResult>(
            "result", to_hear, [this](const ActionResultConstPtr &result) { tell(result); });
        goal_publisher_   = node_.template advertise<ActionGoal>("goal", to_send);
        cancel_publisher_ = node_.template advertise<actionlib_msgs::GoalID>("cancel", to_send);
    }
    ~ActionClient()
    {
        for (const boost::weak_ptr<Sent> &each : goals_)
        {
            if (const boost::shared_ptr<Sent> goal = each.lock())
            {
                goal->client = nullptr;
            }
        }
    }
    ActionClient(const ActionClient &) = delete;
    ActionClient &operator=(const ActionClient &) = delete;

    // Send a goal; the callbacks are called for as long as there is a handle of it.
    GoalHandle sendGoal(const Goal &goal, TransitionCallback on_transition = TransitionCallback(),
                        FeedbackCallback on_feedback = FeedbackCallback())
    {
        const boost::shared_ptr<Sent> sent = boost::make_shared<Sent>();
        sent->message                      = boost::make_shared<ActionGoal>();
        sent->message->header.stamp        = ros::Time::now();
        sent->message->goal_id             = ids_.generateID();
        sent->message->goal                = goal;
        sent->on_transition                = on_transition;
        sent->on_feedback                  = on_feedback;
        sent->client                       = this;
        goals_.push_back(sent);
        goal_publisher_.publish(*sent->message);
        return GoalHandle(sent);
    }

    void cancelAllGoals() { cancel_publisher_.publish(actionlib_msgs::GoalID()); }
    void cancelGoalsAtAndBeforeTime(const ros::Time &time)
    {
        actionlib_msgs::GoalID id;
        id.stamp = time;
        cancel_publisher_.publish(id);
    }

    // Whether a server takes goals, within a time; 0 waits for ever.
    bool waitForActionServerToStart(const ros::Duration &timeout = ros::Duration(0, 0))
    {
        return roscfe::wait_until(timeout, [this]() { return isServerConnected(); });
    }
    bool isServerConnected()
    {
        return has_status_ && goal_publisher_.getNumSubscribers() > 0 && cancel_publisher_.getNumSubscribers() > 0;
    }

  private:
    friend class ClientGoalHandle<ActionSpec>;
    typedef roscfe::SentGoal<ActionSpec> Sent;

    std::uint32_t queue_size(const char *parameter) const
    {
        int size = 10;
        node_.param(parameter, size, 10);
        return size < 0 ? 10 : static_cast<std::uint32_t>(size);
    }

    // Tell all goals of a message. Their callbacks may send more, and may wait, in which time more messages come.
    template <class M>
    void tell(const M &message)
    {
        ++telling_;
        for (std::size_t i = 0; i < goals_.size(); ++i)
        {
            GoalHandle handle(goals_[i].lock());
            if (!handle.isExpired())
            {
                handle.hear(message);
            }
        }
        if (--telling_ == 0)
        {
            forget();
        }
    }

    // Give up goals that have no handle.
    void forget()
    {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < goals_.size(); ++i)
        {
            if (!goals_[i].expired())
            {
                goals_[kept++] = goals_[i];
            }
        }
        goals_.resize(kept);
    }

    ros::NodeHandle                    node_;
    GoalIDGenerator                    ids_;
    std::vector<boost::weak_ptr<Sent>> goals_;
    unsigned                           telling_    = 0;
    bool                               has_status_ = false;
    ros::Publisher                     goal_publisher_;
    ros::Publisher                     cancel_publisher_;
    ros::Subscriber                    status_subscriber_;
    ros::Subscriber                    feedback_subscriber_;
    ros::Subscriber                    result_subscriber_;
};

} // namespace actionlib

#endif
