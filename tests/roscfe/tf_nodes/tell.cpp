// Tells where a robot is, 20 times a second, and for ever where its sensor is on it.
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <tf/transform_broadcaster.h>
#include <tf2_ros/static_transform_broadcaster.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "tell");
  ros::NodeHandle node;
  tf::TransformBroadcaster broadcaster;
  static tf2_ros::StaticTransformBroadcaster fixed;
  geometry_msgs::TransformStamped sensor;
  sensor.header.stamp = ros::Time::now();
  sensor.header.frame_id = "base_link";
  sensor.child_frame_id = "a_sensor_with_a_long_name";
  sensor.transform.translation.z = 0.5;
  sensor.transform.rotation.w = 1.0;
  fixed.sendTransform(sensor);
  ros::Publisher seen = node.advertise<geometry_msgs::PointStamped>("seen", 10);
  ros::Rate rate(20.0);
  for (int step = 0; ros::ok(); ++step)
  {
    const double turn = 0.25 * step;
    tf::Transform transform;
    transform.setOrigin(tf::Vector3(0.25 * step, 2.0, 0.0));
    tf::Quaternion q;
    q.setRPY(0, 0, turn - 6.0);
    transform.setRotation(q);
    broadcaster.sendTransform(tf::StampedTransform(transform, ros::Time::now(), "map", "base_link"));
    geometry_msgs::PointStamped point;
    point.header.stamp = ros::Time::now();  // before the next transform is there
    point.header.frame_id = "a_sensor_with_a_long_name";
    point.point.x = step;
    seen.publish(point);
    rate.sleep();
  }
}
