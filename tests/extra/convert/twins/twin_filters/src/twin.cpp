// Messages of two topics that have one time.
#include <message_filters/subscriber.h>
#include <message_filters/time_synchronizer.h>
#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/String.h>

static ros::Publisher out;

static void both(const sensor_msgs::ImuConstPtr &imu, const geometry_msgs::PoseStampedConstPtr &pose)
{
    std_msgs::String message;
    message.data = std::to_string(imu->header.stamp.toNSec()) + " " + imu->header.frame_id + " " + pose->header.frame_id;
    out.publish(message);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh;
    out = nh.advertise<std_msgs::String>("out", 100);
    message_filters::Subscriber<sensor_msgs::Imu>            imu(nh, "imu", 10);
    message_filters::Subscriber<geometry_msgs::PoseStamped> pose(nh, "pose", 10);
    message_filters::TimeSynchronizer<sensor_msgs::Imu, geometry_msgs::PoseStamped> synchronizer(imu, pose, 5);
    synchronizer.registerCallback(boost::bind(&both, _1, _2));
    ros::spin();
}
