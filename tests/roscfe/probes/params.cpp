// What getParam makes of each type of parameter, defaults, trees, and search.
#include <cstdio>
#include <map>
#include <sstream>

#include <ros/ros.h>

typedef XmlRpc::XmlRpcValue Value;

static std::string text(const std::string &value) { return "'" + value + "'"; }
static std::string text(double value)
{
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.9g", value);
    return buffer;
}
static std::string text(float value) { return text(static_cast<double>(value)); }
static std::string text(int value) { return std::to_string(value); }
static std::string text(bool value) { return value ? "true" : "false"; }
template <class T>
std::string text(const std::vector<T> &values)
{
    std::string all = "[";
    for (const T &value : values)
    {
        all += text(value) + " ";
    }
    return all + "]";
}
template <class T>
std::string text(const std::map<std::string, T> &values)
{
    std::string all = "{";
    for (const auto &each : values)
    {
        all += each.first + "=" + text(each.second) + " ";
    }
    return all + "}";
}

template <class T>
void read(ros::NodeHandle &nh, const std::string &name, const char *type, T value)
{
    const T    start  = value;
    const bool got    = nh.getParam(name, value);
    T          cached = start;
    const bool again  = nh.getParamCached(name, cached);
    T          third  = start;
    const bool bare   = ros::param::get(nh.resolveName(name), third);
    std::printf("P| %s as %s: %d %s, cached %d %s, %d %s\n", name.c_str(), type, got, text(value).c_str(), again,
                text(cached).c_str(), bare, text(third).c_str());
    T          fourth = T();
    const bool param  = nh.param(name, fourth, start);
    std::printf("P|   param %d %s, %s\n", param, text(fourth).c_str(), text(nh.param(name, start)).c_str());
}

static void read_all(ros::NodeHandle &nh, const std::string &name)
{
    read(nh, name, "string", std::string("none"));
    read(nh, name, "double", 7.5);
    read(nh, name, "float", 7.5f);
    read(nh, name, "int", 7);
    read(nh, name, "bool", true);
    read(nh, name, "strings", std::vector<std::string>{"none"});
    read(nh, name, "doubles", std::vector<double>{7.5});
    read(nh, name, "floats", std::vector<float>{7.5f});
    read(nh, name, "ints", std::vector<int>{7});
    read(nh, name, "bools", std::vector<bool>{true});
    read(nh, name, "map of strings", std::map<std::string, std::string>{{"none", "x"}});
    read(nh, name, "map of doubles", std::map<std::string, double>{{"none", 7.5}});
    read(nh, name, "map of floats", std::map<std::string, float>{{"none", 7.5f}});
    read(nh, name, "map of ints", std::map<std::string, int>{{"none", 7}});
    read(nh, name, "map of bools", std::map<std::string, bool>{{"none", true}});
    Value      value;
    const bool got = nh.getParam(name, value);
    std::printf("P| %s is %d, of type %d\n", name.c_str(), got, value.getType());
}

template <class T>
void check(ros::NodeHandle &nh, const char *name, const T &value)
{
    nh.setParam(name, value);
    read_all(nh, name);
    nh.deleteParam(name);
}

static void search(ros::NodeHandle &nh, const char *key)
{
    std::string found = "before", bare = "before";
    try
    {
        const bool got   = nh.searchParam(key, found);
        const bool again = ros::param::search(key, bare);
        std::printf("P| search %s: %d %s, %d %s\n", key, got, found.c_str(), again, bare.c_str());
    }
    catch (const ros::Exception &error)
    {
        std::printf("P| search %s: %s\n", key, error.what());
    }
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "params");
    ros::NodeHandle nh, own("~");
    check(own, "text", "words");
    check(own, "empty", std::string());
    check(own, "digits", "12");
    check(own, "int", 3);
    check(own, "negative", -4);
    check(own, "double", 2.5);
    check(own, "more", 2.51);
    check(own, "below", -2.5);
    check(own, "whole", 4.0);
    check(own, "yes", true);
    check(own, "no", false);
    check(own, "texts", std::vector<std::string>{"a", "b c"});
    check(own, "doubles", std::vector<double>{0.5, -1.75, 3});
    check(own, "floats", std::vector<float>{0.5f, 0.1f});
    check(own, "ints", std::vector<int>{1, -2});
    check(own, "bools", std::vector<bool>{true, false});
    check(own, "nothing", std::vector<int>());
    Value mixed;
    mixed[0] = 1;
    mixed[1] = "two";
    mixed[2] = 3.5;
    check(own, "mixed", mixed);
    check(own, "map", std::map<std::string, double>{{"p", 0.5}, {"i", 2}});
    check(own, "words", std::map<std::string, std::string>{{"a", "x"}, {"b", "y"}});
    check(own, "counts", std::map<std::string, int>{{"a", 1}, {"b", 2}});
    check(own, "flags", std::map<std::string, bool>{{"a", true}, {"b", false}});
    read_all(own, "absent");
    own.setParam("int", 3);
    own.setParam("map", std::map<std::string, double>{{"p", 0.5}, {"i", 2}});
    own.setParam("text", "words");
    ros::param::set("/top", 1);
    ros::param::set("/probes/middle", 2);
    own.setParam("tree/branch/leaf", 5);
    for (const char *key : {"top", "middle", "text", "tree/branch", "tree/absent", "absent", "/top", "~int", "", "/"})
    {
        search(nh, key);
        search(own, key);
    }
    std::printf("P| has %d %d %d %d\n", own.hasParam("tree"), own.hasParam("tree/branch/leaf"), own.hasParam("tree/x"),
                ros::param::has("~int"));
    std::printf("P| delete %d %d\n", own.deleteParam("tree/branch"), own.deleteParam("absent"));
    std::printf("P| then has %d\n", own.hasParam("tree/branch"));
    own.setParam("map", 3);
    read(own, "map", "int", 7);
    read(own, "map/p", "double", 7.5);
    own.setParam("map/deep", 4);
    read(own, "map", "int", 7);
    read(own, "map/deep", "int", 7);
    std::map<std::string, int> few{{"only", 1}};
    own.setParam("counts", few);
    read(own, "counts", "map of ints", std::map<std::string, int>());
    return 0;
}
