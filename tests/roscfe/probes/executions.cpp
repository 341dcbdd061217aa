// The thread in which a simple action server calls its execute callback, beside the main thread of the node.
#include <cstdio>

#include <actionlib/TestAction.h>
#include <actionlib/client/simple_action_client.h>
#include <actionlib/server/simple_action_server.h>
#include <boost/bind.hpp>
#include <boost/thread.hpp>
#include <ros/ros.h>

typedef actionlib::SimpleActionServer<actionlib::TestAction> Server;
typedef actionlib::SimpleActionClient<actionlib::TestAction> Client;

static boost::thread::id       main_thread;
static Server *               server; // which its callback uses until the destructor has waited for it
static int                     turns; // of the main thread's loop
static bool                    is_executing;

static actionlib::TestGoal goal(int number)
{
    actionlib::TestGoal made;
    made.goal = number;
    return made;
}

static actionlib::TestResult result(int number)
{
    actionlib::TestResult made;
    made.result = number;
    return made;
}

static void execute(const actionlib::TestGoalConstPtr &given)
{
    is_executing     = true;
    const int before = turns;
    std::printf("P| execute %d: in the main thread %d\n", given->goal, boost::this_thread::get_id() == main_thread);
    bool is_preempted = false;
    for (int i = 0; i < 10 && !is_preempted; ++i)
    {
        ros::Duration(0.1).sleep();
        is_preempted = server->isPreemptRequested();
        if (i == 2)
        {
            actionlib::TestFeedback feedback;
            feedback.feedback = given->goal * 10;
            server->publishFeedback(feedback);
        }
    }
    std::printf("P| execute %d: preempted %d, new goal %d, the main thread went on %d\n", given->goal, is_preempted,
                server->isNewGoalAvailable(), turns > before + 5);
    if (given->goal == 4)
    {
        is_executing = false;
        return; // without an end
    }
    if (is_preempted)
    {
        server->setPreempted(result(-given->goal), "preempted");
    }
    else
    {
        server->setSucceeded(result(given->goal), "done");
    }
    is_executing = false;
}

static void done(int sent, const actionlib::SimpleClientGoalState &state, const actionlib::TestResultConstPtr &given)
{
    std::printf("P| done %d: %s '%s', result %d, in the main thread %d\n", sent, state.toString().c_str(),
                state.getText().c_str(), given->result, boost::this_thread::get_id() == main_thread);
}

static void fed(const actionlib::TestFeedbackConstPtr &given)
{
    std::printf("P| feedback %d: in the main thread %d, while it executes %d\n", given->feedback,
                boost::this_thread::get_id() == main_thread, is_executing);
}

static void loop(double seconds)
{
    const ros::Time until = ros::Time::now() + ros::Duration(seconds);
    while (ros::Time::now() < until)
    {
        ros::spinOnce();
        ++turns;
        ros::Duration(0.02).sleep();
    }
}

static void send(Client &client, int number)
{
    std::printf("P| send %d\n", number);
    client.sendGoal(goal(number), boost::bind(done, number, _1, _2), Client::SimpleActiveCallback(), fed);
}

int main(int argc, char **argv)
{
    std::setbuf(stdout, nullptr);
    ros::init(argc, argv, "probe");
    ros::NodeHandle nh;
    main_thread = boost::this_thread::get_id();
    server = new Server(nh, "run", execute, false);
    server->start();
    Client client("run", false); // its callbacks come from the main thread's spinOnce
    while (!client.isServerConnected())
    {
        loop(0.1);
    }

    send(client, 1);
    loop(1.6);
    std::printf("P| cancelled\n");
    send(client, 2);
    loop(0.5);
    client.cancelGoal();
    loop(0.6);
    std::printf("P| followed by another\n");
    Client second("run", true); // its callbacks come from a thread of its own
    while (!second.isServerConnected())
    {
        loop(0.1);
    }
    send(client, 3);
    loop(0.5);
    send(second, 4);
    loop(2);
    std::printf("P| waits in the main thread, without spinning\n");
    const actionlib::SimpleClientGoalState state = second.sendGoalAndWait(goal(5), ros::Duration(5), ros::Duration(1));
    std::printf("P| waited: %s\n", state.toString().c_str());
    std::printf("P| nothing spins: the server does not hear of the goal\n");
    loop(1.6);

    std::printf("P| shut down while it executes\n");
    send(client, 6);
    loop(0.5);
    std::printf("P| executes %d\n", is_executing);
    server->shutdown();
    std::printf("P| shut down: executes %d\n", is_executing);
    loop(0.3);
    send(client, 7);
    loop(0.5);
    std::printf("P| active %d, new goal %d\n", server->isActive(), server->isNewGoalAvailable());
    client.stopTrackingGoal();
    delete server;

    std::printf("P| destroyed while it executes\n");
    server = new Server(nh, "run", execute, true);
    loop(0.5);
    send(client, 8);
    loop(0.5);
    delete server;
    std::printf("P| destroyed: executes %d\n", is_executing);
    loop(0.3);
    std::printf("P| end\n");
    return 0;
}
