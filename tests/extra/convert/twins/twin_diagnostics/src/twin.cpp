// A diagnostic updater with tasks of three forms, once a second.
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

using diagnostic_updater::DiagnosticStatusWrapper;

static int g_calls = 0;

static void function(DiagnosticStatusWrapper &status)
{
    status.summaryf(diagnostic_msgs::DiagnosticStatus::OK, "call %d", ++g_calls);
    status.add("calls", g_calls);
    status.add("text", "some text");
}

struct Device
{
    void check(DiagnosticStatusWrapper &status)
    {
        g_calls % 3 == 0 ? status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "third")
                         : status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "not third");
        status.addf("rest", "%d of 3", g_calls % 3);
    }
};

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle             nh;
    diagnostic_updater::Updater updater;
    Device                      device;
    updater.setHardwareID("a device");
    updater.add("function", function);
    updater.add("method", &device, &Device::check);
    ros::Duration(1.0).sleep();
    for (int i = 0; i < 6 && ros::ok(); ++i)
    {
        updater.force_update();
        ros::Duration(1.0).sleep();
    }
    ros::spin();
}
