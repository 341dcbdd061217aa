// Goals of actions with handles on both sides: the states that a client sees, callbacks, cancellation, lost goals.
#include <cstdio>
#include <string>

#include <actionlib/TestAction.h>
#include <actionlib/client/action_client.h>
#include <actionlib/client/simple_action_client.h>
#include <actionlib/server/action_server.h>
#include <ros/ros.h>

typedef actionlib::ActionClient<actionlib::TestAction>       Client;
typedef actionlib::SimpleActionClient<actionlib::TestAction> SimpleClient;
typedef actionlib::ActionServer<actionlib::TestAction>       Server;

static Server::GoalHandle asked; // the last goal that came to the server

static void take(Server::GoalHandle handle)
{
    asked = handle;
    std::printf("P| server: goal %d\n", handle.getGoal()->goal);
}
static void cancel(Server::GoalHandle handle)
{
    std::printf("P| server: cancel %d in status %d\n", handle.getGoal()->goal, handle.getGoalStatus().status);
}
static void changed(Client::GoalHandle handle)
{
    std::printf("P|   %s\n", handle.getCommState().toString().c_str());
}
static void heard(Client::GoalHandle handle, const actionlib::TestFeedbackConstPtr &feedback)
{
    std::printf("P|   feedback %d in %s\n", feedback->feedback, handle.getCommState().toString().c_str());
}

static void spin()
{
    for (int i = 0; i < 30; ++i)
    {
        ros::Duration(0.01).sleep();
        ros::spinOnce();
    }
}

static Client::GoalHandle send(Client &client, int number)
{
    actionlib::TestGoal goal;
    goal.goal = number;
    std::printf("P| goal %d\n", number);
    Client::GoalHandle handle = client.sendGoal(goal, changed, heard);
    std::printf("P| %s\n", handle.getCommState().toString().c_str());
    spin();
    return handle;
}

static actionlib::TestResult result(int number)
{
    actionlib::TestResult made;
    made.result = number;
    return made;
}

static void told(const Client::GoalHandle &handle)
{
    const actionlib::TerminalState       state = handle.getTerminalState();
    const actionlib::TestResultConstPtr made  = handle.getResult();
    std::printf("P| ended %s '%s' result %d\n", state.toString().c_str(), state.getText().c_str(), made ? made->result : -1);
}

static void with_handles(Client &client)
{
    Client::GoalHandle handle = send(client, 1);
    asked.setAccepted("taken");
    spin();
    actionlib::TestFeedback feedback;
    feedback.feedback = 11;
    asked.publishFeedback(feedback);
    spin();
    asked.setSucceeded(result(12), "well");
    spin();
    told(handle);
    handle.cancel(); // which is too late
    spin();

    handle = send(client, 2);
    asked.setRejected(result(22), "no");
    spin();
    told(handle);

    handle = send(client, 3);
    handle.cancel();
    spin();
    asked.setCanceled(result(32), "recalled");
    spin();
    told(handle);

    handle = send(client, 4);
    asked.setAccepted();
    spin();
    handle.cancel();
    spin();
    std::printf("P| asked for the end while %s\n", handle.getTerminalState().toString().c_str());
    asked.setCanceled(result(42), "preempted");
    spin();
    told(handle);

    handle = send(client, 5);
    asked.setAccepted();
    asked.setAborted(result(52), "in one go");
    spin();
    told(handle);

    handle = send(client, 6);
    asked.setAccepted();
    spin();
    client.cancelAllGoals();
    spin();
    asked.setSucceeded(result(62), "all the same");
    spin();
    told(handle);
    handle.resend(); // the server knows it
    spin();

    std::printf("P| handles\n");
    handle                   = send(client, 7);
    Client::GoalHandle other = handle;
    std::printf("P| equal %d, to none %d, expired %d %d\n", handle == other, handle == Client::GoalHandle(),
                handle.isExpired(), Client::GoalHandle().isExpired());
    handle.reset();
    asked.setAccepted();
    spin();
    std::printf("P| expired %d, other %s\n", handle.isExpired(), other.getCommState().toString().c_str());
    other.reset();
    asked.setSucceeded(result(72), "nobody hears");
    spin();

    Client::GoalHandle first = send(client, 8), second = send(client, 9);
    client.cancelGoalsAtAndBeforeTime(ros::Time::now());
    spin();
    std::printf("P| %s %s %d\n", first.getCommState().toString().c_str(), second.getCommState().toString().c_str(), first != second);
    asked.setCanceled();
    spin();
    std::printf("P| %s %s\n", first.getCommState().toString().c_str(), second.getCommState().toString().c_str());
}

static void done(const actionlib::SimpleClientGoalState &state, const actionlib::TestResultConstPtr &made)
{
    std::printf("P|   done %s '%s' %d\n", state.toString().c_str(), state.getText().c_str(), made ? made->result : -1);
}
static void active() { std::printf("P|   active\n"); }
static void progress(const actionlib::TestFeedbackConstPtr &feedback) { std::printf("P|   feedback %d\n", feedback->feedback); }

static void simply(SimpleClient &client)
{
    std::printf("P| simple client\n");
    std::printf("P| %s, waited %d\n", client.getState().toString().c_str(), client.waitForResult(ros::Duration(0.1)));
    actionlib::TestGoal goal;
    goal.goal = 20;
    client.sendGoal(goal, done, active, progress);
    spin();
    std::printf("P| %s\n", client.getState().toString().c_str());
    asked.setAccepted();
    spin();
    std::printf("P| %s, waited %d\n", client.getState().toString().c_str(), client.waitForResult(ros::Duration(0.1)));
    actionlib::TestFeedback feedback;
    feedback.feedback = 21;
    asked.publishFeedback(feedback);
    spin();
    client.cancelGoal();
    spin();
    std::printf("P| %s\n", client.getState().toString().c_str());
    asked.setCanceled(result(22), "as asked");
    spin();
    std::printf("P| %s '%s' result %d, waited %d\n", client.getState().toString().c_str(), client.getState().getText().c_str(),
                client.getResult()->result, client.waitForResult(ros::Duration(0.1)));
    goal.goal = 23;
    client.sendGoal(goal, done, active);
    client.cancelGoal(); // before the server has said anything
    spin();
    asked.setCanceled(result(24), "early");
    spin();
    std::printf("P| %s\n", client.getState().toString().c_str());
    goal.goal = 25;
    client.sendGoal(goal, done, active);
    spin();
    client.stopTrackingGoal();
    asked.setAccepted();
    asked.setSucceeded(result(26));
    spin();
    std::printf("P| %s\n", client.getState().toString().c_str());
}

static actionlib_msgs::GoalID last;
static void note(const actionlib::TestActionGoal::ConstPtr &goal) { last = goal->goal_id; }

// A server of which only statuses are seen.
static void without_server(ros::NodeHandle &nh)
{
    std::printf("P| statuses alone\n");
    ros::Publisher  status = nh.advertise<actionlib_msgs::GoalStatusArray>("shy/status", 10);
    ros::Publisher  made   = nh.advertise<actionlib::TestActionResult>("shy/result", 10);
    ros::Subscriber goals  = nh.subscribe("shy/goal", 10, note);
    Client client("shy");
    spin();
    std::printf("P| connected %d\n", client.isServerConnected());
    actionlib_msgs::GoalStatusArray all;
    status.publish(all);
    spin();
    Client::GoalHandle handle = send(client, 30);
    all.status_list.resize(1);
    const unsigned char says[] = {actionlib_msgs::GoalStatus::PENDING, actionlib_msgs::GoalStatus::PREEMPTING,
                                  actionlib_msgs::GoalStatus::ACTIVE,  actionlib_msgs::GoalStatus::RECALLING,
                                  actionlib_msgs::GoalStatus::ABORTED, actionlib_msgs::GoalStatus::ACTIVE};
    for (unsigned char each : says)
    {
        std::printf("P| says %d\n", each);
        all.status_list[0].goal_id = last;
        all.status_list[0].status  = each;
        status.publish(all);
        spin();
    }
    actionlib::TestActionResult end;
    end.status        = all.status_list[0];
    end.status.status = actionlib_msgs::GoalStatus::SUCCEEDED;
    end.result.result = 31;
    made.publish(end);
    spin();
    told(handle);

    handle                     = send(client, 32);
    all.status_list[0].goal_id = last;
    all.status_list[0].status  = actionlib_msgs::GoalStatus::ACTIVE;
    status.publish(all);
    spin();
    std::printf("P| forgets\n");
    status.publish(actionlib_msgs::GoalStatusArray());
    spin();
    told(handle);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "actions");
    ros::NodeHandle nh;
    Server          server(nh, "count", take, cancel, false);
    server.start();
    Client client("count");
    while (!client.isServerConnected())
    {
        spin();
    }
    with_handles(client);
    SimpleClient simple("count", false);
    while (!simple.isServerConnected())
    {
        spin();
    }
    simply(simple);
    without_server(nh);
    return 0;
}
