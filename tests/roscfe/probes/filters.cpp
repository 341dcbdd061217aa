// tf2_ros::MessageFilter and tf2_ros::Buffer in one node: messages that wait for a transform, that come too late, that
// have no frame, and more of them than the queue has places; waits for transforms without a thread.
#include <cstdio>
#include <string>
#include <vector>

#include <geometry_msgs/PointStamped.h>
#include <message_filters/subscriber.h>
#include <ros/ros.h>
#include <tf2_msgs/FrameGraph.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/message_filter.h>
#include <tf2_ros/transform_listener.h>

typedef geometry_msgs::PointStamped       Point;
typedef tf2_ros::MessageFilter<Point>     Filter;

static void passed(const Point::ConstPtr &point) { std::printf("P|   passed %g\n", point->point.x); }
static void failed(const Point::ConstPtr &point, tf2_ros::FilterFailureReason reason)
{
    std::printf("P|   failed %g: %d\n", point->point.x, static_cast<int>(reason));
}

static void spin(int times = 10)
{
    for (int i = 0; i < times; ++i)
    {
        ros::Duration(0.01).sleep();
        ros::spinOnce();
    }
}

static Point::Ptr point(double number, const std::string &frame, const ros::Time &time)
{
    Point::Ptr made(new Point);
    made->header.frame_id = frame;
    made->header.stamp    = time;
    made->point.x         = number;
    return made;
}

static void set(tf2::BufferCore &buffer, const std::string &parent, const std::string &child, double time, double x)
{
    geometry_msgs::TransformStamped made;
    made.header.frame_id         = parent;
    made.header.stamp            = ros::Time(time);
    made.child_frame_id          = child;
    made.transform.translation.x = x;
    made.transform.rotation.w    = 1;
    buffer.setTransform(made, "probe");
}

static void filtered(tf2_ros::Buffer &buffer, ros::NodeHandle &nh, bool with_queue)
{
    std::printf("P| %s queue\n", with_queue ? "with a" : "without a");
    Filter *filter = with_queue ? new Filter(buffer, "map", 3, nh) : new Filter(buffer, "/map", 3, nullptr);
    filter->registerCallback(passed);
    filter->registerFailureCallback(failed);
    std::printf("P| '%s', %u\n", filter->getTargetFramesString().c_str(), filter->getQueueSize());
    std::printf("P| in time\n");
    filter->add(point(1, "base", ros::Time(10)));
    filter->add(point(2, "/base", ros::Time(11)));
    filter->add(point(3, "map", ros::Time(30)));
    spin();
    std::printf("P| too late, and without a frame\n");
    filter->add(point(4, "base", ros::Time(0.5)));
    filter->add(point(5, "", ros::Time(10)));
    spin();
    std::printf("P| waiting\n");
    filter->add(point(6, "base", ros::Time(14)));
    filter->add(point(7, "new", ros::Time(10)));
    spin();
    set(buffer, "map", "base", 14, 4);
    spin();
    std::printf("P| more than wait\n");
    for (int number = 10; number < 15; ++number)
    {
        filter->add(point(number, "base", ros::Time(number + 10)));
    }
    spin();
    std::printf("P| the buffer moves on\n");
    set(buffer, "map", "base", 24, 5);
    spin();
    std::printf("P| with a tolerance\n");
    filter->setTolerance(ros::Duration(1));
    filter->add(point(20, "base", ros::Time(23.5)));
    spin();
    set(buffer, "map", "base", 25, 5);
    spin();
    std::printf("P| two frames\n");
    filter->setTolerance(ros::Duration(0));
    std::vector<std::string> both = {"map", "/odom"};
    filter->setTargetFrames(both);
    std::printf("P| '%s'\n", filter->getTargetFramesString().c_str());
    filter->add(point(21, "base", ros::Time(25)));
    spin();
    set(buffer, "odom", "map", 20, 1);
    set(buffer, "odom", "map", 26, 1);
    spin();
    std::printf("P| other frames while one waits\n");
    filter->add(point(26, "base", ros::Time(27.5)));
    filter->setTargetFrames(both);
    std::printf("P| cleared\n");
    filter->add(point(22, "base", ros::Time(28)));
    filter->clear();
    set(buffer, "map", "base", 28, 5);
    set(buffer, "odom", "map", 28, 1);
    spin();
    std::printf("P| without a limit\n");
    filter->setQueueSize(0);
    std::printf("P| %u\n", filter->getQueueSize());
    filter->add(point(23, "base", ros::Time(29)));
    filter->add(point(24, "base", ros::Time(29.5)));
    set(buffer, "odom", "map", 30, 1);
    set(buffer, "map", "base", 30, 1);
    spin();
    std::printf("P| gone while one waits\n");
    filter->add(point(25, "base", ros::Time(40)));
    delete filter;
    set(buffer, "map", "base", 41, 1);
    spin();
}

static void asked(tf2_ros::Buffer &buffer)
{
    std::printf("P| waits\n");
    std::string why;
    const ros::Duration brief(0.05);
    std::printf("P| %d\n", buffer.canTransform("map", "base", ros::Time(99), brief, &why));
    std::printf("P| told %d\n", why.find("dedicated thread") != std::string::npos);
    buffer.setUsingDedicatedThread(true);
    why.clear();
    std::printf("P| %d\n", buffer.canTransform("map", "base", ros::Time(99), brief, &why));
    std::printf("P| told %d\n", why.find("canTransform returned after") != std::string::npos);
    std::printf("P| %d\n", buffer.canTransform("map", "base", ros::Time(11), brief, &why));
    std::printf("P| %d\n", buffer.canTransform("map", ros::Time(11), "base", ros::Time(12), "map", brief, &why));
    std::printf("P| %d\n", buffer.canTransform("map", ros::Time(11), "base", ros::Time(99), "map", brief));
    std::printf("P| x %g\n", buffer.lookupTransform("map", "base", ros::Time(11), brief).transform.translation.x);
    std::printf("P| x %g\n",
                buffer.lookupTransform("map", ros::Time(11), "base", ros::Time(10), "map", brief).transform.translation.x);
    try
    {
        buffer.lookupTransform("map", "base", ros::Time(99), brief);
    }
    catch (const tf2::ExtrapolationException &)
    {
        std::printf("P| extrapolation\n");
    }
    try
    {
        buffer.lookupTransform("map", "nowhere", ros::Time(0));
    }
    catch (const tf2::LookupException &)
    {
        std::printf("P| lookup\n");
    }
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "filters");
    ros::NodeHandle nh;
    tf2_ros::Buffer buffer(ros::Duration(10), true);
    std::printf("P| service %d\n", ros::service::exists("~tf2_frames", false));
    for (int second = 5; second < 13; ++second)
    {
        set(buffer, "map", "base", second, second);
    }
    asked(buffer);
    filtered(buffer, nh, true);
    buffer.clear();
    for (int second = 5; second < 13; ++second)
    {
        set(buffer, "map", "base", second, second);
    }
    filtered(buffer, nh, false);
    return 0;
}
