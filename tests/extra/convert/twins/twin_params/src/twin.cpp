// What ros::param and ros::NodeHandle say of parameters.
#include <iomanip>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <std_msgs/String.h>

static ros::Publisher out;

static void say(const std::string &what, const std::string &value)
{
    std_msgs::String message;
    message.data = what + ": " + value;
    out.publish(message);
}

static std::string text(bool value) { return value ? "true" : "false"; }
static std::string text(int value) { return std::to_string(value); }
static std::string text(double value)
{
    std::ostringstream made;
    made << std::fixed << std::setprecision(6) << value;
    return made.str();
}
static std::string text(const std::string &value) { return "'" + value + "'"; }
template <class T>
static std::string text(const std::vector<T> &values)
{
    std::string made = "[";
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        made += (i > 0 ? ", " : "") + text(static_cast<T>(values[i]));
    }
    return made + "]";
}
template <class T>
static std::string text(const std::map<std::string, T> &values)
{
    std::string made = "{";
    for (const auto &each : values)
    {
        made += (made.size() > 1 ? ", " : "") + each.first + "=" + text(each.second);
    }
    return made + "}";
}

// A tree, with the types of its leaves.
static std::string tree(XmlRpc::XmlRpcValue &value)
{
    std::string made;
    switch (value.getType())
    {
        case XmlRpc::XmlRpcValue::TypeBoolean: return text(static_cast<bool>(value));
        case XmlRpc::XmlRpcValue::TypeInt: return text(static_cast<int>(value));
        case XmlRpc::XmlRpcValue::TypeDouble: return text(static_cast<double>(value));
        case XmlRpc::XmlRpcValue::TypeString: return text(static_cast<std::string>(value));
        case XmlRpc::XmlRpcValue::TypeArray:
            for (int i = 0; i < value.size(); ++i)
            {
                made += (i > 0 ? ", " : "") + tree(value[i]);
            }
            return "[" + made + "]";
        case XmlRpc::XmlRpcValue::TypeStruct:
            for (XmlRpc::XmlRpcValue::iterator each = value.begin(); each != value.end(); ++each)
            {
                made += (made.empty() ? "" : ", ") + each->first + "=" + tree(each->second);
            }
            return "{" + made + "}";
        default: return "?";
    }
}

template <class T>
static void get(ros::NodeHandle &nh, const std::string &name)
{
    T value{};
    say("get " + nh.resolveName(name), nh.getParam(name, value) ? text(value) : "none");
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "another_name");
    ros::NodeHandle nh, own("~"), below("sub"), root("/"), below_own(own, "deep");
    out = nh.advertise<std_msgs::String>("said", 200);
    ros::Duration(1.0).sleep();
    say("name", ros::this_node::getName() + " " + ros::this_node::getNamespace());
    say("namespaces", nh.getNamespace() + " " + own.getNamespace() + " " + below.getNamespace() + " " +
                          root.getNamespace() + " " + below_own.getNamespace());
    say("topic", out.getTopic() + " " + nh.resolveName("said") + " " + own.resolveName("x") + " " + ros::names::resolve("~y"));
    get<bool>(own, "flag");
    get<int>(own, "count");
    get<double>(own, "count");
    get<double>(own, "ratio");
    get<double>(own, "whole");
    get<std::string>(own, "word");
    get<std::string>(own, "number_text");
    get<std::string>(own, "empty");
    get<std::string>(own, "nothing");
    get<int>(own, "word");
    get<std::string>(own, "count");
    get<double>(root, "/top");
    get<int>(nh, "speed");
    get<int>(nh, "/robot/speed");
    get<std::vector<int>>(root, "/numbers");
    get<std::vector<double>>(root, "/reals");
    get<std::vector<bool>>(root, "/flags");
    get<std::vector<std::string>>(root, "/words");
    get<std::string>(root, "/long_text");
    get<std::string>(root, "/a_namespace_with_a_name/that_is_long_enough_to_need/more_than_one_row_of_the_table");
    XmlRpc::XmlRpcValue value;
    root.getParam("/gains", value);
    say("gains", tree(value));
    root.getParam("/mixed", value);
    say("mixed", tree(value));
    double p = 0, missing = 0;
    own.param("ratio", p, 9.0);
    own.param("missing", missing, 9.5);
    say("defaults", text(p) + " " + text(missing) + " " + text(own.param("count", 5)) + " " +
                        text(own.param<std::string>("absent", "default")) + " " + text(ros::param::param("/top", 1.0)));
    std::string found;
    say("search", (own.searchParam("speed", found) ? found : "none") + " " + (own.searchParam("top", found) ? found : "none") +
                      " " + (own.searchParam("word", found) ? found : "none") + " " +
                      (own.searchParam("nowhere", found) ? found : "none"));
    say("has", text(own.hasParam("flag")) + text(own.hasParam("none")) + text(root.hasParam("/gains")) +
                   text(ros::param::has("/gains/deep/er/yet")));
    own.setParam("made", 3);
    own.setParam("made_text", "some text");
    own.setParam("made_list", std::vector<double>{1.5, 2.5});
    std::map<std::string, double> map;
    map["a"] = 1;
    map["b"] = 2.5;
    own.setParam("made_map", map);
    get<int>(own, "made");
    get<std::string>(own, "made_text");
    get<std::vector<double>>(own, "made_list");
    get<std::map<std::string, double>>(own, "made_map");
    get<double>(own, "made_map/b");
    own.setParam("made", true);
    get<bool>(own, "made");
    const bool first = own.deleteParam("made"), there = own.hasParam("made"), second = own.deleteParam("made");
    say("delete", text(first) + text(there) + text(second));
    XmlRpc::XmlRpcValue made;
    made["list"][0] = 1;
    made["list"][1] = 2.5;
    made["list"][2] = std::string("three");
    made["inner"]["yes"] = true;
    made["text"] = "t";
    say("made", tree(made));
    own.setParam("made_tree", made);
    XmlRpc::XmlRpcValue again;
    own.getParam("made_tree", again);
    say("again", tree(again));
    say("members", text(again.hasMember("inner")) + text(again.hasMember("outer")) + " " + text(static_cast<int>(again["list"].size())));
    for (int i = 0; i < 3; ++i)
    {
        double cached = 0;
        own.setParam("cached", i * 0.5);
        own.getParamCached("cached", cached);
        say("cached", text(cached));
    }
    ros::spin();
}
