// A server of dynamic_reconfigure: what its callback gets, one that throws, and changes of the node's own.
#include <stdexcept>

#include <dynamic_reconfigure/server.h>
#include <ros/ros.h>
#include <tuned/TuneConfig.h>

void changed(tuned::TuneConfig &config, uint32_t level)
{
  ROS_INFO("level %x: %d %g %s %d %d, groups %d %d %d %d", level, config.count, config.gain, config.title.c_str(),
           config.on, config.last, config.groups.state, config.groups.outer.state, config.groups.outer.inner.state,
           config.groups.other.state);
  if (config.count == 13)
  {
    throw std::runtime_error("not thirteen");
  }
  if (config.count == 14)
  {
    throw 14;
  }
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "tuned");
  ros::NodeHandle nh;
  dynamic_reconfigure::Server<tuned::TuneConfig> server;
  server.setCallback(changed);
  tuned::TuneConfig config = tuned::TuneConfig::__getDefault__();
  config.last = 2;
  server.updateConfig(config);
  server.updateConfig(config);
  ros::spin();
}
