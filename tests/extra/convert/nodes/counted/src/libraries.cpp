// Transforms over and over, and where ~pairs says so messages of one time: cfepy counts what malloc gives.
#include <geometry_msgs/PointStamped.h>
#include <message_filters/subscriber.h>
#include <message_filters/time_synchronizer.h>
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

static int g_pairs = 0;

static void both(const geometry_msgs::PointStampedConstPtr &, const geometry_msgs::PointStampedConstPtr &)
{
    ++g_pairs;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "libraries");
    ros::NodeHandle               nh, own("~");
    ros::Publisher                left  = nh.advertise<geometry_msgs::PointStamped>("left", 5);
    ros::Publisher                right = nh.advertise<geometry_msgs::PointStamped>("right", 5);
    ros::Publisher                found = nh.advertise<std_msgs::Int32>("found", 5);
    tf2_ros::Buffer               buffer;
    tf2_ros::TransformListener    listener(buffer);
    tf2_ros::TransformBroadcaster broadcaster;
    message_filters::Subscriber<geometry_msgs::PointStamped> one(nh, "left", 5), other(nh, "right", 5);
    message_filters::TimeSynchronizer<geometry_msgs::PointStamped, geometry_msgs::PointStamped> pairs(one, other, 5);
    pairs.registerCallback(boost::bind(&both, _1, _2));
    const bool has_pairs = own.param("pairs", false);

    geometry_msgs::TransformStamped transform;
    transform.header.frame_id      = "world";
    transform.child_frame_id       = "base";
    transform.transform.rotation.w = 1.0;
    geometry_msgs::PointStamped point;
    std_msgs::Int32             sum;
    for (ros::Rate rate(20); ros::ok(); rate.sleep())
    {
        transform.header.stamp = point.header.stamp = ros::Time::now();
        broadcaster.sendTransform(transform);
        if (has_pairs)
        {
            left.publish(point);
            right.publish(point);
        }
        ros::spinOnce();
        if (buffer.canTransform("world", "base", ros::Time(0)))
        {
            const double w = buffer.lookupTransform("world", "base", ros::Time(0)).transform.rotation.w;
            sum.data       = static_cast<int>(w * 1000) + g_pairs;
        }
        found.publish(sum);
    }
}
