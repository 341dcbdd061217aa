// Asks where things are, in all the ways that there are, and waits for what is not there yet.
#include <boost/bind.hpp>
#include <geometry_msgs/PointStamped.h>
#include <message_filters/subscriber.h>
#include <ros/ros.h>
#include <tf/message_filter.h>
#include <tf/transform_listener.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>
#include <tf2_ros/transform_listener.h>

class Ear
{
public:
  Ear() : listener2_(buffer_), seen_(node_, "seen", 5), filter_(seen_, listener_, "/map", 10)
  {
    filter_.registerCallback(boost::bind(&Ear::seen, this, _1));
    timer_ = node_.createTimer(ros::Duration(0.5), &Ear::look, this);
  }

  void seen(const geometry_msgs::PointStamped::ConstPtr &message)
  {
    geometry_msgs::PointStamped here;
    listener_.transformPoint("/map", *message, here);
    ROS_INFO("seen %g in %s, stamp kept %d", message->point.x, here.header.frame_id.c_str(),
             here.header.stamp == message->header.stamp);
  }

  void look(const ros::TimerEvent &)
  {
    std::string error;
    const ros::Time now = ros::Time::now();
    const bool there = listener_.waitForTransform("/map", "/a_sensor_with_a_long_name", now, ros::Duration(1.0));
    tf::StampedTransform transform;
    try
    {
      listener_.lookupTransform("/map", "/a_sensor_with_a_long_name", now, transform);
      ROS_INFO("waited %d, lag under 0.06 %d, height %g", there, ros::Time::now() - now < ros::Duration(0.06),
               transform.getOrigin().z());
      listener_.lookupTransform("map", "nowhere", ros::Time(0), transform);
    }
    catch (tf::TransformException &ex)
    {
      ROS_INFO("%s", ex.what());
    }
    geometry_msgs::PointStamped arm;
    arm.header.frame_id = "python_arm";
    arm.point.x = 1;
    arm = buffer_.transform(arm, "base_link");
    ROS_INFO("arm %g %g in %s", arm.point.x, arm.point.y, arm.header.frame_id.c_str());
    const bool never = buffer_.canTransform("map", "nowhere", ros::Time(0), ros::Duration(0.02), &error);
    ROS_INFO("never: %d %s", never, error.substr(0, 79).c_str());
  }

private:
  ros::NodeHandle node_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener2_;
  tf::TransformListener listener_;
  message_filters::Subscriber<geometry_msgs::PointStamped> seen_;
  tf::MessageFilter<geometry_msgs::PointStamped> filter_;
  ros::Timer timer_;
};

int main(int argc, char **argv)
{
  ros::init(argc, argv, "hear");
  Ear ear;
  ros::spin();
  return 0;
}
