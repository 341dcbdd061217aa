// Goals at the edges of actionlib: handles without a goal, transitions that are refused, goals and cancellations that are
// published without a client, and results that nobody waits for.
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

static Server::GoalHandle asked;

static void take(Server::GoalHandle handle)
{
    asked = handle;
    std::printf("P| server: goal %d, id given %d, stamp given %d\n", handle.getGoal()->goal,
                !handle.getGoalID().id.empty(), !handle.getGoalID().stamp.isZero());
}
static void cancel(Server::GoalHandle handle)
{
    std::printf("P| server: cancel %d in status %d\n", handle.getGoal()->goal, handle.getGoalStatus().status);
}

static void spin(int times = 30)
{
    for (int i = 0; i < times; ++i)
    {
        ros::Duration(0.01).sleep();
        ros::spinOnce();
    }
}

template <class AnyClient>
static void connect(AnyClient &client)
{
    while (!client.isServerConnected())
    {
        spin();
    }
}

static actionlib::TestResult result(int number)
{
    actionlib::TestResult made;
    made.result = number;
    return made;
}

static void heard(const actionlib::TestActionResult::ConstPtr &message)
{
    std::printf("P| result %d of '%s', status %d '%s'\n", message->result.result, message->status.goal_id.id.c_str(),
                message->status.status, message->status.text.c_str());
}

static int statuses;
static void count(const actionlib_msgs::GoalStatusArray::ConstPtr &) { ++statuses; }

static void show(const char *what)
{
    std::printf("P| %s: status %d\n", what, asked.getGoalStatus().status);
}

// Goals that are published as messages, without a client.
static void published(ros::NodeHandle &nh)
{
    ros::Publisher  goals    = nh.advertise<actionlib::TestActionGoal>("count/goal", 10);
    ros::Publisher  cancels  = nh.advertise<actionlib_msgs::GoalID>("count/cancel", 10);
    ros::Subscriber results  = nh.subscribe("count/result", 10, heard);
    spin();
    actionlib::TestActionGoal goal;
    goal.goal.goal = 1;
    std::printf("P| a goal without an identifier\n");
    goals.publish(goal);
    spin();
    asked.setAccepted();
    spin();

    std::printf("P| cancelled before it comes\n");
    actionlib_msgs::GoalID id;
    id.id = "early";
    cancels.publish(id);
    spin();
    goal.goal.goal    = 2;
    goal.goal_id.id   = "early";
    goals.publish(goal);
    spin();
    show("still the one before");

    std::printf("P| a second goal of the same name\n");
    goal.goal.goal  = 3;
    goal.goal_id.id = "twice";
    goals.publish(goal);
    spin();
    goals.publish(goal);
    spin();

    std::printf("P| cancelled by time\n");
    id.id    = "";
    id.stamp = ros::Time::now();
    cancels.publish(id);
    spin();
    goal.goal.goal     = 4;
    goal.goal_id.id    = "old";
    goal.goal_id.stamp = id.stamp - ros::Duration(1);
    goals.publish(goal);
    spin();
    goal.goal.goal     = 5;
    goal.goal_id.id    = "new";
    goal.goal_id.stamp = ros::Time::now();
    goals.publish(goal);
    spin();
    std::printf("P| all are cancelled\n");
    cancels.publish(actionlib_msgs::GoalID());
    spin();
    asked.setCanceled(result(51), "by all");
    spin();
    std::printf("P| the text of an accepted goal that is cancelled\n");
    goal.goal.goal     = 6;
    goal.goal_id.id    = "texts";
    goal.goal_id.stamp = ros::Time::now();
    goals.publish(goal);
    spin();
    asked.setAccepted("taken");
    cancels.publish(actionlib_msgs::GoalID());
    spin();
    std::printf("P| status %d '%s'\n", asked.getGoalStatus().status, asked.getGoalStatus().text.c_str());
    asked.setSucceeded(result(61));
    spin();
    std::printf("P| status %d '%s'\n", asked.getGoalStatus().status, asked.getGoalStatus().text.c_str());
}

static void refused_by_the_server()
{
    std::printf("P| refused transitions\n");
    show("now");
    asked.setAccepted();
    show("accepted after its end");
    asked.setSucceeded(result(0));
    asked.setAborted(result(0));
    asked.setRejected(result(0));
    asked.setCanceled(result(0));
    show("all the same");
    Server::GoalHandle none;
    none.setAccepted();
    none.setRejected();
    none.setAborted();
    none.setSucceeded();
    none.setCanceled();
    none.publishFeedback(actionlib::TestFeedback());
    std::printf("P| none: goal %d, id '%s', status %d, same %d\n", static_cast<bool>(none.getGoal()),
                none.getGoalID().id.c_str(), none.getGoalStatus().status, none == Server::GoalHandle());
    std::printf("P| other %d\n", none != asked);
}

static void without_callbacks(Client &client)
{
    std::printf("P| without callbacks\n");
    actionlib::TestGoal goal;
    goal.goal                 = 60;
    Client::GoalHandle handle = client.sendGoal(goal);
    spin();
    asked.setAborted(result(61), "while it waits"); // refused
    show("pending");
    asked.setAccepted();
    asked.publishFeedback(actionlib::TestFeedback());
    spin();
    asked.setRejected(result(62), "too late"); // refused
    show("active");
    std::printf("P| %s\n", handle.getCommState().toString().c_str());
    asked.setSucceeded(result(63));
    spin();
    std::printf("P| %s, %s, result %d\n", handle.getCommState().toString().c_str(),
                handle.getTerminalState().toString().c_str(), handle.getResult()->result);
    handle.cancel();
    Client::GoalHandle none;
    std::printf("P| none: expired %d\n", none.isExpired());
    none.reset();
}

static void outlived(ros::NodeHandle &nh)
{
    std::printf("P| a client that has gone\n");
    Client::GoalHandle handle;
    {
        Client client(nh, "count");
        connect(client);
        actionlib::TestGoal goal;
        goal.goal = 70;
        handle    = client.sendGoal(goal);
        spin();
        asked.setAccepted();
        spin();
    }
    asked.setSucceeded(result(71));
    spin();
    std::printf("P| expired %d\n", handle.isExpired());
}

static void simply(SimpleClient &client)
{
    std::printf("P| simply\n");
    actionlib::TestGoal goal;
    for (int end = 0; end < 3; ++end)
    {
        goal.goal = 80 + end;
        client.sendGoal(goal);
        spin();
        if (end == 0)
        {
            asked.setRejected(result(1), "no");
        }
        else
        {
            asked.setAccepted();
            spin();
            end == 1 ? asked.setAborted(result(2), "broken") : asked.setSucceeded(result(3), "fine");
        }
        spin();
        std::printf("P| %s '%s' %d\n", client.getState().toString().c_str(), client.getState().getText().c_str(),
                    client.getResult()->result);
    }
    goal.goal = 90;
    std::printf("P| in time: %s\n", client.sendGoalAndWait(goal, ros::Duration(0.2), ros::Duration(0.2)).toString().c_str());
    spin();
    client.stopTrackingGoal();
    std::printf("P| %s\n", client.getState().toString().c_str());
    client.cancelGoal();
    client.stopTrackingGoal();
    client.cancelAllGoals();
    spin();
    client.cancelGoalsAtAndBeforeTime(ros::Time::now());
    spin();
}

// Statuses and results of a server that contradict each other.
static actionlib_msgs::GoalID last;
static void note(const actionlib::TestActionGoal::ConstPtr &goal) { last = goal->goal_id; }

static void contradicting(ros::NodeHandle &nh)
{
    std::printf("P| contradicting\n");
    ros::Publisher  status = nh.advertise<actionlib_msgs::GoalStatusArray>("shy/status", 10);
    ros::Publisher  made   = nh.advertise<actionlib::TestActionResult>("shy/result", 10);
    ros::Publisher  rest   = nh.advertise<actionlib::TestActionFeedback>("shy/feedback", 10);
    ros::Subscriber goals  = nh.subscribe("shy/goal", 10, note);
    Client          client("shy");
    spin();
    actionlib_msgs::GoalStatusArray all;
    status.publish(all);
    spin();
    actionlib::TestGoal goal;
    Client::GoalHandle  handle = client.sendGoal(goal);
    spin();
    actionlib::TestActionFeedback feedback;
    feedback.status.goal_id = last;
    rest.publish(feedback);
    feedback.status.goal_id.id = "another";
    rest.publish(feedback);
    actionlib::TestActionResult end;
    end.status.goal_id.id = "another";
    made.publish(end);
    spin();
    std::printf("P| %s\n", handle.getCommState().toString().c_str());
    end.status.goal_id = last;
    for (int status_of_it : {5, 3})
    {
        end.status.status = static_cast<unsigned char>(status_of_it);
        made.publish(end);
        spin();
        std::printf("P| %s, %s\n", handle.getCommState().toString().c_str(), handle.getTerminalState().toString().c_str());
    }
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "goals");
    ros::NodeHandle nh;
    nh.setParam("count/status_frequency", 20.0);
    nh.setParam("actionlib_status_frequency", 10.0);
    Server server(nh, "count", take, cancel, false);
    server.start();
    server.start();
    Server          other(nh, "other", true);
    ros::Subscriber all = nh.subscribe("count/status", 10, count);
    spin();
    published(nh);
    refused_by_the_server();
    Client client("count");
    connect(client);
    without_callbacks(client);
    outlived(nh);
    SimpleClient simple("count", true);
    connect(simple);
    std::printf("P| there %d\n", simple.waitForServer(ros::Duration(5)));
    simply(simple);
    contradicting(nh);
    std::printf("P| statuses came %d\n", statuses > 50);
    return 0;
}
