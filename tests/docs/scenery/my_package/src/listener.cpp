// Counts what the talker says.
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt32.h>

class Listener
{
public:
  Listener()
  {
    heard_ = node_.advertise<std_msgs::UInt32>("heard", 10);
    chatter_ = node_.subscribe("chatter", 10, &Listener::onChatter, this);
  }

private:
  void onChatter(const std_msgs::String::ConstPtr &)
  {
    count_.data += 1;
    heard_.publish(count_);
  }

  ros::NodeHandle node_;
  ros::Publisher heard_;
  ros::Subscriber chatter_;
  std_msgs::UInt32 count_;
};

int main(int argc, char **argv)
{
  ros::init(argc, argv, "listener");
  Listener listener;
  ros::spin();
  return 0;
}
