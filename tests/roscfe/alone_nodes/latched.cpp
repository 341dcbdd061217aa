// Asks a publisher that has ended whether it is latched. roscpp ends the node for that.
#include <cstdio>

#include <ros/ros.h>
#include <std_msgs/String.h>

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    ros::NodeHandle node;
    ros::Publisher  told = node.advertise<std_msgs::String>("a", 1, true);
    std::printf("P| %d\n", told.isLatched());
    told.shutdown();
    std::printf("P| %d\n", told.isLatched());
    return 0;
}
