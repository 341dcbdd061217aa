// Takes memory after its start, which is its end in the profile strict.
#include <ros/ros.h>

int main(int argc, char **argv)
{
    ros::init(argc, argv, "greedy");
    ros::NodeHandle  nh;
    std::vector<int> before(100);
    ros::spinOnce();
    ROS_INFO("working, with %d", static_cast<int>(before.size()));
    before.push_back(1);
    ROS_INFO("took more");
    ros::spin();
}
