// A broadcaster of two transforms, a static one, and a listener that puts them together.
#include <geometry_msgs/TransformStamped.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

static geometry_msgs::TransformStamped transform(const char *parent, const char *child, double x)
{
    geometry_msgs::TransformStamped made;
    made.header.stamp            = ros::Time::now();
    made.header.frame_id         = parent;
    made.child_frame_id          = child;
    made.transform.translation.x = x;
    made.transform.rotation.z    = 0.6;
    made.transform.rotation.w    = 0.8;
    return made;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle                      nh;
    ros::Publisher                       out = nh.advertise<geometry_msgs::TransformStamped>("out", 10);
    tf2_ros::Buffer                      buffer;
    tf2_ros::TransformListener           listener(buffer);
    tf2_ros::TransformBroadcaster        broadcaster;
    tf2_ros::StaticTransformBroadcaster still;
    ros::Duration(1.0).sleep();
    still.sendTransform(transform("tool", "tip", 0.5));
    for (int i = 0; i < 20; ++i)
    {
        broadcaster.sendTransform(transform("world", "base", i * 0.25));
        broadcaster.sendTransform(transform("base", "tool", 1.0));
        ros::Duration(0.2).sleep();
        ros::spinOnce();
        if (buffer.canTransform("world", "tip", ros::Time(0)))
        {
            geometry_msgs::TransformStamped found = buffer.lookupTransform("world", "tip", ros::Time(0));
            found.header.stamp = ros::Time(); // tf2_py takes times as floats, and so is some nanoseconds off
            out.publish(found);
        }
    }
    ros::spin();
}
