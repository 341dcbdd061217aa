// A node that has what is the whole process's elsewhere: handlers of signals, and random numbers.
#include <csignal>
#include <cstdlib>

#include <ros/ros.h>

static void quit(int number)
{
    ROS_INFO("signal %d", number);
    ros::shutdown();
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "handler", ros::init_options::NoSigintHandler);
    ros::NodeHandle nh;
    struct sigaction before{};
    ROS_INFO("first %d", std::signal(SIGINT, SIG_IGN) == SIG_DFL);
    ROS_INFO("then %d", std::signal(SIGINT, quit) == SIG_IGN);
    const int status = sigaction(SIGINT, nullptr, &before);
    ROS_INFO("asked %d %d", status, before.sa_handler == quit);
    ROS_INFO("refused %d", std::signal(SIGKILL, quit) == SIG_ERR);
    ROS_INFO("drawn %d", std::rand());
    ros::spin();
    ROS_INFO("spun");
}
