// A nodelet with what nodelets have: node handles of both kinds, also those for several threads, its name, a log.
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>

namespace twin_nodelet
{

class Twin : public nodelet::Nodelet
{
  public:
    void onInit() override
    {
        ros::NodeHandle &nh  = getNodeHandle();
        ros::NodeHandle &own = getPrivateNodeHandle();
        own.param("gain", gain_, 1.0);
        out_   = nh.advertise<std_msgs::String>("out", 100);
        ticks_ = own.advertise<std_msgs::Float64>("ticks", 10);
        in_    = nh.subscribe("in", 10, &Twin::heard, this);
        more_  = getMTNodeHandle().subscribe("more", 10, &Twin::heard_more, this);
        set_   = getMTPrivateNodeHandle().advertiseService("pause", &Twin::pause, this);
        timer_ = nh.createTimer(ros::Duration(0.35), &Twin::tick, this);
        NODELET_INFO("%s with gain %.1f", getName().c_str(), gain_);
    }

  private:
    void say(const std::string &what)
    {
        std_msgs::String message;
        message.data = what;
        out_.publish(message);
    }

    void heard(const std_msgs::Int32::ConstPtr &message)
    {
        last_ = message->data;
        say(getName() + " heard " + std::to_string(message->data));
    }

    void heard_more(const std_msgs::Int32 &message) { say("more " + std::to_string(message.data)); }

    void tick(const ros::TimerEvent &)
    {
        if (!paused_)
        {
            std_msgs::Float64 tick;
            tick.data = gain_ * last_;
            ticks_.publish(tick);
        }
    }

    bool pause(std_srvs::SetBool::Request &request, std_srvs::SetBool::Response &response)
    {
        paused_          = request.data;
        response.success = true;
        response.message = paused_ ? "paused" : "goes on";
        return true;
    }

    ros::Publisher     out_, ticks_;
    ros::Subscriber    in_, more_;
    ros::ServiceServer set_;
    ros::Timer         timer_;
    double             gain_   = 0;
    int                last_   = 0;
    bool               paused_ = false;
};

} // namespace twin_nodelet

PLUGINLIB_EXPORT_CLASS(twin_nodelet::Twin, nodelet::Nodelet)
