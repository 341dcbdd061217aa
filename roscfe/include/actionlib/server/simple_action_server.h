// actionlib::SimpleActionServer: one goal at a time, and a new one preempts it.
#ifndef ROSCFE_ACTIONLIB_SERVER_SIMPLE_ACTION_SERVER_H
#define ROSCFE_ACTIONLIB_SERVER_SIMPLE_ACTION_SERVER_H

#include <boost/thread/recursive_mutex.hpp>

#include <bitset> // these three come with ROS's header, and nodes rely on it
#include <deque>
#include <optional>

#include <string>
#include <utility>

#if defined(ROSCFE_PROFILE_HOST) // these three come with ROS's header, and nodes rely on it
#include "boost/thread/condition_variable.hpp"
#include "boost/thread/shared_mutex.hpp"
#include "boost/thread/thread_only.hpp"
#endif

#include "actionlib/server/action_server.h"
#include "roscfe/helpers.h"
#include "roscfe/waiting.h"

namespace actionlib
{

// The execute callback runs in a thread of its own in a node for the host. In other nodes it runs from the node's spinning:
// while it waits, in Rate::sleep or Duration::sleep, goals and cancellations are taken, and the node's other callbacks run,
// as they would in the main thread of a roscpp node.
template <class ActionSpec>
class SimpleActionServer
{
  public:
    ACTION_DEFINITION(ActionSpec)
    typedef typename ActionServer<ActionSpec>::GoalHandle     GoalHandle;
    typedef boost::function<void(const GoalConstPtr &)> ExecuteCallback;

    SimpleActionServer(const std::string &name, ExecuteCallback execute, bool auto_start)
        : SimpleActionServer(ros::NodeHandle(), name, execute, auto_start)
    {
    }
    SimpleActionServer(const std::string &name, ExecuteCallback execute)
        : SimpleActionServer(ros::NodeHandle(), name, execute, true)
    {
    }
    SimpleActionServer(const std::string &name, bool auto_start)
        : SimpleActionServer(ros::NodeHandle(), name, ExecuteCallback(), auto_start)
    {
    }
    SimpleActionServer(ros::NodeHandle node, const std::string &name, ExecuteCallback execute)
        : SimpleActionServer(node, name, execute, true)
    {
    }
    SimpleActionServer(ros::NodeHandle node, const std::string &name, bool auto_start)
        : SimpleActionServer(node, name, ExecuteCallback(), auto_start)
    {
    }
    SimpleActionServer(ros::NodeHandle node, const std::string &name, ExecuteCallback execute, bool auto_start)
        : queue_(dynamic_queue(node)),
          execute_(execute),
          server_(
              node, name, [this](GoalHandle goal) { take(goal); }, [this](GoalHandle goal) { cancel(goal); }, false)
    {
        if (execute_ && roscfe::start_helper != nullptr)
        {
            thread_ = roscfe::start_helper(execute_in_thread, this);
        }
        if (execute_ && thread_ == nullptr)
        {
            task_ = boost::make_shared<Execution>(this);
            queue_->expect(1);
        }
        if (auto_start)
        {
            start();
        }
    }
    ~SimpleActionServer() { shutdown(); }

    void start() { server_.start(); }
    void shutdown()
    {
        if (task_)
        {
            task_->server = nullptr;
        }
        if (thread_ != nullptr)
        {
            roscfe::stop_helper(std::exchange(thread_, nullptr));
        }
    }

    bool isNewGoalAvailable() { return new_goal_; }
    bool isPreemptRequested() { return preempt_request_; }
    bool isActive()
    {
        const unsigned status = current_.getGoalStatus().status;
        return current_.isValid() &&
               (status == actionlib_msgs::GoalStatus::ACTIVE || status == actionlib_msgs::GoalStatus::PREEMPTING);
    }

    // The goal that came last; the one before is preempted.
    GoalConstPtr acceptNewGoal()
    {
        if (!new_goal_ || !next_.isValid())
        {
            ROS_ERROR_NAMED("actionlib", "Attempting to accept the next goal when a new goal is not available");
            return GoalConstPtr();
        }
        if (isActive() && current_ != next_)
        {
            current_.setCanceled(Result(), "This goal was canceled because another goal was recieved by the simple "
                                           "action server");
        }
        current_                  = next_;
        new_goal_                 = false;
        preempt_request_          = new_goal_preempt_request_;
        new_goal_preempt_request_ = false;
        current_.setAccepted("This goal has been accepted by the simple action server");
        return current_.getGoal();
    }

    void setSucceeded(const Result &result = Result(), const std::string &text = std::string())
    {
        current_.setSucceeded(result, text);
    }
    void setAborted(const Result &result = Result(), const std::string &text = std::string())
    {
        current_.setAborted(result, text);
    }
    void setPreempted(const Result &result = Result(), const std::string &text = std::string())
    {
        current_.setCanceled(result, text);
    }
    void publishFeedback(const Feedback &feedback) { current_.publishFeedback(feedback); }
    void publishFeedback(const FeedbackConstPtr &feedback) { current_.publishFeedback(*feedback); }

    void registerGoalCallback(boost::function<void()> callback)
    {
        if (execute_)
        {
            ROS_WARN_NAMED("actionlib", "Cannot call ActionServer.registerGoalCallback() because an executeCallback "
                                        "exists. Not going to register it.");
            return;
        }
        on_goal_ = callback;
    }
    void registerPreemptCallback(boost::function<void()> callback) { on_preempt_ = callback; }

  private:
    typedef actionlib_msgs::GoalStatus Status;

    // One execution of the callback, which waits for its turn among the node's callbacks.
    struct Execution final : ros::CallbackInterface
    {
        explicit Execution(SimpleActionServer *of) : server(of) {}
        CallResult call() override
        {
            waiting = false;
            if (server != nullptr)
            {
                server->execute();
            }
            return Success;
        }
        SimpleActionServer *server;
        bool                waiting = false;
    };

    static ros::CallbackQueue *dynamic_queue(ros::NodeHandle &node)
    {
        return static_cast<ros::CallbackQueue *>(node.getCallbackQueue());
    }

    void take(GoalHandle goal)
    {
        const ros::Time mine    = goal.getGoalID().stamp;
        const bool      is_last = (!current_.isValid() || mine >= current_.getGoalID().stamp) &&
                             (!next_.isValid() || mine >= next_.getGoalID().stamp);
        if (!is_last)
        {
            goal.setCanceled(Result(), "This goal was canceled because another goal was recieved by the simple action "
                                       "server");
            return;
        }
        if (next_.isValid() && (!current_.isValid() || next_ != current_))
        {
            next_.setCanceled(Result(), "This goal was canceled because another goal was recieved by the simple action "
                                        "server");
        }
        next_                     = goal;
        new_goal_                 = true;
        new_goal_preempt_request_ = false;
        if (isActive())
        {
            preempt_request_ = true;
            if (on_preempt_)
            {
                on_preempt_();
            }
        }
        if (on_goal_)
        {
            on_goal_();
        }
        request_execution();
    }

    void cancel(GoalHandle goal)
    {
        if (goal == current_)
        {
            preempt_request_ = true;
            if (on_preempt_)
            {
                on_preempt_();
            }
        }
        else if (goal == next_)
        {
            new_goal_preempt_request_ = true;
        }
    }

    void request_execution()
    {
        if (task_ && !task_->waiting && !executing_)
        {
            task_->waiting = true;
            queue_->addCallback(task_);
        }
        if (thread_ != nullptr)
        {
            roscfe::wake_helper(thread_);
        }
    }

    void execute()
    {
        executing_ = true;
        roscfe::start_async(queue_); // the node's other callbacks, while this one waits
        while (new_goal_ && !ros::isShuttingDown())
        {
            execute_next();
        }
        roscfe::stop_async(queue_);
        executing_ = false;
    }

    void execute_next()
    {
        const GoalConstPtr goal = acceptNewGoal();
        execute_(goal);
        if (isActive())
        {
            ROS_WARN_NAMED("actionlib", "Your executeCallback did not set the goal to a terminal status.\n"
                                        "This is a bug in your ActionServer implementation. Fix your code!\n"
                                        "For now, the ActionServer will set this goal to aborted");
            setAborted(Result(), "This goal was aborted by the simple action server. The user should have set a "
                                 "terminal status on this goal and did not");
        }
    }

    static void execute_in_thread(void *thing, const bool &is_stopped)
    {
        auto *server = static_cast<SimpleActionServer *>(thing);
        while (!is_stopped && !ros::isShuttingDown())
        {
            if (server->new_goal_ && !server->isActive())
            {
                server->execute_next();
            }
            else
            {
                roscfe::wait_in_helper(ros::WallDuration(0.1)); // how often roscpp's looks
            }
        }
    }

    ros::CallbackQueue *         queue_;
    ExecuteCallback              execute_;
    boost::function<void()>      on_goal_;
    boost::function<void()>      on_preempt_;
    GoalHandle                   current_;
    GoalHandle                   next_;
    bool                         new_goal_                 = false;
    bool                         preempt_request_          = false;
    bool                         new_goal_preempt_request_ = false;
    bool                         executing_                = false;
    boost::shared_ptr<Execution> task_;
    roscfe::Helper *             thread_ = nullptr;
    ActionServer<ActionSpec>     server_;
};

} // namespace actionlib

#endif
