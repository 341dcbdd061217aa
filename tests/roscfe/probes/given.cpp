// What a node is given at its start, and says of itself: private parameters and remaps in its own arguments, texts with
// signs of control and numbers that JSON does not have in parameters, its lines on /rosout, and its logger's level.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <ros/console.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>

static void spin(int times = 30)
{
    for (int i = 0; i < times; ++i)
    {
        ros::Duration(0.01).sleep();
        ros::spinOnce();
    }
}

static void shown(const ros::NodeHandle &own, const char *name)
{
    XmlRpc::XmlRpcValue value;
    if (!own.getParam(name, value))
    {
        std::printf("P| %s: none\n", name);
        return;
    }
    std::printf("P| %s: type %d, ", name, static_cast<int>(value.getType()));
    switch (value.getType())
    {
        case XmlRpc::XmlRpcValue::TypeInt: std::printf("%d\n", static_cast<int>(value)); break;
        case XmlRpc::XmlRpcValue::TypeDouble: std::printf("%.17g\n", static_cast<double>(value)); break;
        case XmlRpc::XmlRpcValue::TypeBoolean: std::printf("%d\n", static_cast<bool>(value)); break;
        case XmlRpc::XmlRpcValue::TypeString:
            for (const char letter : static_cast<std::string>(value))
            {
                std::printf(letter >= ' ' && letter != '%' ? "%c" : "%%%02x", static_cast<unsigned char>(letter));
            }
            std::printf("\n");
            break;
        default: std::printf("size %d\n", value.size());
    }
}

static void given(const ros::NodeHandle &own)
{
    std::printf("P| given\n");
    for (const char *name : {"i", "n", "far", "d", "e", "huge", "hex", "inf", "nan", "t", "f", "F", "yes", "s", "empty", "space", "sub/deep"})
    {
        shown(own, name);
    }
    std::printf("P| %s %s\n", own.resolveName("left").c_str(), own.resolveName("right").c_str());
}

static void kept(ros::NodeHandle &own)
{
    std::printf("P| kept\n");
    own.setParam("text", std::string("tab\t return\r feed\f back\b quote\" slash\\ bell\a end\n"));
    own.setParam("foreign", std::string("\xc3\xa4\xe2\x82\xac"));
    own.setParam("tiny", std::numeric_limits<double>::denorm_min());
    own.setParam("third", 1.0 / 3);
    own.setParam("large", 1e300);
    own.setParam("negative", -0.0);
    own.setParam("least", std::numeric_limits<int>::min());
    for (const char *name : {"text", "foreign", "tiny", "third", "large", "negative", "least"})
    {
        shown(own, name);
    }
    std::vector<bool> bits = {true, false};
    own.setParam("bits", bits);
    std::map<std::string, double> named = {{"one", 1}, {"two", 2.5}};
    own.setParam("named", named);
    std::vector<float> numbers = {1.5F, -2};
    own.setParam("numbers", numbers);
    bits.clear();
    named.clear();
    numbers.clear();
    std::printf("P| %d %d %d\n", own.getParam("bits", bits), own.getParam("named", named), own.getParam("numbers", numbers));
    std::printf("P| %zu %zu %zu, %g\n", bits.size(), named.size(), numbers.size(), named["two"]);
    std::vector<int> whole;
    std::printf("P| doubles as integers: %d, %zu\n", own.getParam("numbers", whole), whole.size());
    std::map<std::string, std::string> texts;
    std::printf("P| as texts: %d\n", own.getParam("named", texts));
    std::printf("P| has %d\n", own.hasParam("bits"));
    std::printf("P| deletes %d\n", own.deleteParam("bits"));
    std::printf("P| has %d\n", own.hasParam("bits"));
    std::string found;
    std::printf("P| searched: %d\n", own.searchParam("third", found));
    std::printf("P| '%s'\n", found.c_str());
    std::printf("P| searched: %d\n", own.searchParam("never", found));
    std::printf("P| %g %g\n", own.param("third", 9.0), own.param("never", 9.0));
}

static void line(const rosgraph_msgs::Log::ConstPtr &log)
{
    const char *file = std::strrchr(log->file.c_str(), '/');
    std::printf("P|   level %d of %s: '%s' in %s of %s, line %d\n", log->level, log->name.c_str(), log->msg.c_str(),
                log->function.c_str(), file != nullptr ? file + 1 : log->file.c_str(), log->line > 0);
}

static void said(ros::NodeHandle &nh)
{
    std::printf("P| said\n");
    ros::Subscriber lines = nh.subscribe("/rosout", 20, line);
    spin();
    ROS_DEBUG("not at this level");
    ROS_INFO("plain %d", 1);
    ROS_WARN("a warning");
    ROS_ERROR_STREAM("an error " << 2.5);
    ROS_FATAL("the end");
    spin();
    std::map<std::string, ros::console::levels::Level> loggers;
    std::printf("P| levels: %d, level %d\n", ros::console::get_loggers(loggers), static_cast<int>(loggers[ROSCONSOLE_DEFAULT_NAME]));
}

static void streamed()
{
    std::printf("P| streamed\n");
    ROS_INFO_STREAM("P| " << std::hex << std::showbase << 255 << " " << std::uppercase << 255 << std::dec << " " << 255);
    ROS_INFO_STREAM("P| " << std::oct << 8 << " " << std::setw(6) << std::setfill('.') << std::left << 9 << "|");
    ROS_INFO_STREAM("P| " << std::fixed << std::setprecision(2) << 1.005 << " " << std::scientific << 12345.678);
    ROS_INFO_STREAM("P| " << std::setiosflags(std::ios::fixed | std::ios::scientific) << 1.5 << std::showpos << " " << 3);
    ROS_INFO_STREAM("P| " << std::boolalpha << true << std::noboolalpha << " " << false << " " << 'c' << " "
                          << static_cast<const void *>(nullptr));
    ROS_INFO_STREAM("P| " << std::internal << std::setw(8) << -42 << std::right << std::setw(5) << 7);
    ROS_INFO_STREAM("P| " << std::showpoint << 2.0 << std::noshowpoint << " " << 2.0 << std::endl);
}

int main(int argc, char **argv)
{
    std::vector<std::string> all(argv, argv + argc);
    for (const char *each : {"_i:=12", "_n:=-3", "_far:=4294967296", "_d:=1.5", "_e:=1e3", "_huge:=1e999", "_hex:=0x10", "_inf:=inf",
                             "_nan:=nan", "_t:=true", "_f:=false", "_F:=FALSE", "_yes:=yes", "_s:=some text", "_empty:=",
                             "_space:= 1", "_sub/deep:=7", "left:=/right/side", "no mark"})
    {
        all.push_back(each);
    }
    std::vector<char *> words;
    for (std::string &each : all)
    {
        words.push_back(&each[0]);
    }
    int count = static_cast<int>(words.size());
    words.push_back(nullptr);
    ros::init(count, words.data(), "given");
    std::printf("P| left over: %d, %s\n", count, words[static_cast<std::size_t>(count) - 1]);
    std::vector<std::string> rest;
    ros::removeROSArgs(argc, argv, rest);
    std::printf("P| without ROS's: %zu\n", rest.size());
    std::printf("P| initialized %d, started %d\n", ros::isInitialized(), ros::isStarted());
    ros::NodeHandle nh, own("~");
    given(own);
    kept(own);
    streamed();
    said(nh);
    return 0;
}
