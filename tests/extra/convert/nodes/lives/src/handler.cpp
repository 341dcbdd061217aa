// A node that has what is the whole process's elsewhere: handlers of signals, random numbers, the time.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>

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
    const std::time_t now = std::time(nullptr);
    ROS_INFO("clock %d", static_cast<int>(now - ros::Time::now().sec));
    ros::spin();
    std::printf("spun\n"); // the log has ended
}
