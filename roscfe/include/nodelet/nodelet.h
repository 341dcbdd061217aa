// nodelet::Nodelet: each nodelet is an application of its own, with a task and a pipe.
#ifndef ROSCFE_NODELET_NODELET_H
#define ROSCFE_NODELET_NODELET_H

#include <string>
#include <vector>

#include "ros/ros.h"
#include "roscfe/plugins.h"

#define NODELET_DEBUG(...) ROS_DEBUG_NAMED(getName(), __VA_ARGS__)
#define NODELET_DEBUG_STREAM(...) ROS_DEBUG_STREAM_NAMED(getName(), __VA_ARGS__)
#define NODELET_DEBUG_ONCE(...) ROS_DEBUG_ONCE_NAMED(getName(), __VA_ARGS__)
#define NODELET_DEBUG_COND(cond, ...) ROS_DEBUG_COND_NAMED(cond, getName(), __VA_ARGS__)
#define NODELET_DEBUG_THROTTLE(period, ...) ROS_DEBUG_THROTTLE_NAMED(period, getName(), __VA_ARGS__)
#define NODELET_DEBUG_STREAM_THROTTLE(period, ...) ROS_DEBUG_STREAM_THROTTLE_NAMED(period, getName(), __VA_ARGS__)
#define NODELET_INFO(...) ROS_INFO_NAMED(getName(), __VA_ARGS__)
#define NODELET_INFO_STREAM(...) ROS_INFO_STREAM_NAMED(getName(), __VA_ARGS__)
#define NODELET_INFO_ONCE(...) ROS_INFO_ONCE_NAMED(getName(), __VA_ARGS__)
#define NODELET_INFO_COND(cond, ...) ROS_INFO_COND_NAMED(cond, getName(), __VA_ARGS__)
#define NODELET_INFO_THROTTLE(period, ...) ROS_INFO_THROTTLE_NAMED(period, getName(), __VA_ARGS__)
#define NODELET_INFO_STREAM_THROTTLE(period, ...) ROS_INFO_STREAM_THROTTLE_NAMED(period, getName(), __VA_ARGS__)
#define NODELET_WARN(...) ROS_WARN_NAMED(getName(), __VA_ARGS__)
#define NODELET_WARN_STREAM(...) ROS_WARN_STREAM_NAMED(getName(), __VA_ARGS__)
#define NODELET_WARN_ONCE(...) ROS_WARN_ONCE_NAMED(getName(), __VA_ARGS__)
#define NODELET_WARN_COND(cond, ...) ROS_WARN_COND_NAMED(cond, getName(), __VA_ARGS__)
#define NODELET_WARN_THROTTLE(period, ...) ROS_WARN_THROTTLE_NAMED(period, getName(), __VA_ARGS__)
#define NODELET_WARN_STREAM_THROTTLE(period, ...) ROS_WARN_STREAM_THROTTLE_NAMED(period, getName(), __VA_ARGS__)
#define NODELET_ERROR(...) ROS_ERROR_NAMED(getName(), __VA_ARGS__)
#define NODELET_ERROR_STREAM(...) ROS_ERROR_STREAM_NAMED(getName(), __VA_ARGS__)
#define NODELET_ERROR_ONCE(...) ROS_ERROR_ONCE_NAMED(getName(), __VA_ARGS__)
#define NODELET_ERROR_COND(cond, ...) ROS_ERROR_COND_NAMED(cond, getName(), __VA_ARGS__)
#define NODELET_ERROR_THROTTLE(period, ...) ROS_ERROR_THROTTLE_NAMED(period, getName(), __VA_ARGS__)
#define NODELET_ERROR_STREAM_THROTTLE(period, ...) ROS_ERROR_STREAM_THROTTLE_NAMED(period, getName(), __VA_ARGS__)
#define NODELET_FATAL(...) ROS_FATAL_NAMED(getName(), __VA_ARGS__)
#define NODELET_FATAL_STREAM(...) ROS_FATAL_STREAM_NAMED(getName(), __VA_ARGS__)

namespace nodelet
{

typedef std::vector<std::string>           V_string;
typedef std::map<std::string, std::string> M_string;

class Nodelet
{
  public:
    Nodelet()          = default;
    virtual ~Nodelet() = default;
    Nodelet(const Nodelet &) = delete;
    Nodelet &operator=(const Nodelet &) = delete;

    // Begin: the application's entry point calls it.
    void init(const std::string &name, const M_string &remappings, const V_string &argv,
              ros::CallbackQueueInterface * = nullptr, ros::CallbackQueueInterface * = nullptr)
    {
        name_    = name;
        my_argv_ = argv;
        node_    = boost::make_shared<ros::NodeHandle>("", remappings);
        private_ = boost::make_shared<ros::NodeHandle>("~", remappings);
        onInit();
    }

  protected:
    const std::string &getName() const { return name_; }
    std::string        getSuffixedName(const std::string &suffix) const { return name_ + "." + suffix; }
    const V_string &   getMyArgv() const { return my_argv_; }

    // All handles have one queue: callbacks of a nodelet run one after the other, those of the MT handles too.
    ros::NodeHandle &            getNodeHandle() const { return *node_; }
    ros::NodeHandle &            getPrivateNodeHandle() const { return *private_; }
    ros::NodeHandle &            getMTNodeHandle() const { return *node_; }
    ros::NodeHandle &            getMTPrivateNodeHandle() const { return *private_; }
    ros::CallbackQueueInterface &getSTCallbackQueue() const { return *ros::getGlobalCallbackQueue(); }
    ros::CallbackQueueInterface &getMTCallbackQueue() const { return *ros::getGlobalCallbackQueue(); }

  private:
    virtual void onInit() = 0;

    std::string                        name_;
    V_string                           my_argv_;
    boost::shared_ptr<ros::NodeHandle> node_;
    boost::shared_ptr<ros::NodeHandle> private_;
};

} // namespace nodelet

namespace roscfe
{

// The main function of an application that is a nodelet.
//   type: the nodelet's class, such as "my_package::MyNodelet".
inline int run_nodelet(const char *type, int argc, char **argv)
{
    ros::init(argc, argv, "nodelet");
    boost::shared_ptr<nodelet::Nodelet> made(Plugins<nodelet::Nodelet>::make(type));
    if (!made)
    {
        refuse("the shared object exports no nodelet of this class", type);
    }
    ros::start();
    made->init(ros::this_node::getName(), nodelet::M_string(), nodelet::V_string(argv + 1, argv + argc));
    ros::spin();
    return 0;
}

} // namespace roscfe

#endif
