// A server of an action that counts, and a client of somebody else's.
#include <actionlib/TestAction.h>
#include <actionlib/client/simple_action_client.h>
#include <actionlib/server/simple_action_server.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

static ros::Publisher out;

static void say(const std::string &what)
{
    std_msgs::String message;
    message.data = what;
    out.publish(message);
}

class Counter
{
  public:
    explicit Counter(const std::string &name) : server_(nh_, name, boost::bind(&Counter::execute, this, _1), false)
    {
        server_.start();
    }

  private:
    void execute(const actionlib::TestGoalConstPtr &goal)
    {
        say("goal " + std::to_string(goal->goal));
        ros::Rate rate(10);
        for (int i = 1; i <= goal->goal; ++i)
        {
            if (server_.isPreemptRequested())
            {
                result_.result = -i;
                server_.setPreempted(result_, "preempted");
                return;
            }
            feedback_.feedback = i;
            server_.publishFeedback(feedback_);
            rate.sleep();
        }
        result_.result = goal->goal * 2;
        goal->goal == 3 ? server_.setAborted(result_, "three") : server_.setSucceeded(result_, "counted");
    }

    ros::NodeHandle                                nh_;
    actionlib::SimpleActionServer<actionlib::TestAction> server_;
    actionlib::TestFeedback                        feedback_;
    actionlib::TestResult                          result_;
};

static void done(const actionlib::SimpleClientGoalState &state, const actionlib::TestResultConstPtr &result)
{
    say("done " + state.toString() + " " + std::to_string(result->result));
}
static void active() { say("active"); }
static void feedback(const actionlib::TestFeedbackConstPtr &message) { say("feedback " + std::to_string(message->feedback)); }

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh;
    out = nh.advertise<std_msgs::String>("out", 100);
    Counter counter("count");
    actionlib::SimpleActionClient<actionlib::TestAction> client("other", true);
    client.waitForServer();
    ros::Time::sleepUntil(ros::Time(ros::Time::now().sec + 2));
    actionlib::TestGoal goal;
    goal.goal = 4;
    client.sendGoal(goal, done, active, feedback);
    const bool in_time = client.waitForResult(ros::Duration(3.0));
    say(std::string(in_time ? "in time " : "late ") + client.getState().toString());
    ros::spin();
}
