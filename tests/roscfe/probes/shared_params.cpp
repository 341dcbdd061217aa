// Parameters that a node in Python has set, and those that it reads: one parameter server for both.
#include <cmath>
#include <cstdio>
#include <limits>

#include <ros/ros.h>

typedef XmlRpc::XmlRpcValue Value;

static void show(const Value &value, int depth = 0)
{
    switch (value.getType())
    {
        case Value::TypeBoolean:
            std::printf("bool %d", static_cast<bool>(value));
            break;
        case Value::TypeInt:
            std::printf("int %d", static_cast<int>(value));
            break;
        case Value::TypeDouble:
            std::printf("double %.17g", static_cast<double>(value));
            break;
        case Value::TypeString:
            std::printf("text [%s]", static_cast<std::string>(value).c_str());
            break;
        case Value::TypeArray:
            std::printf("array of %d:", value.size());
            for (int i = 0; i < value.size(); ++i)
            {
                std::printf(" ");
                show(value[i], depth + 1);
            }
            break;
        case Value::TypeStruct:
            std::printf("struct:");
            for (auto each = value.begin(); each != value.end(); ++each)
            {
                std::printf(" %s=(", each->first.c_str());
                show(each->second, depth + 1);
                std::printf(")");
            }
            break;
        case Value::TypeBase64:
        {
            const Value::BinaryData &bytes = value;
            std::printf("base64 of %d:", value.size());
            for (const char byte : bytes)
            {
                std::printf(" %02x", static_cast<unsigned char>(byte));
            }
            break;
        }
        case Value::TypeDateTime:
        {
            const std::tm &date = value;
            std::printf("date %d %d %d %d %d %d %d", date.tm_year, date.tm_mon, date.tm_mday, date.tm_hour, date.tm_min,
                        date.tm_sec, date.tm_isdst);
            break;
        }
        default:
            std::printf("type %d", value.getType());
    }
}

static void read(const std::string &name)
{
    Value      value;
    const bool got = ros::param::get(name, value);
    std::printf("P| %s %d ", name.c_str(), got);
    if (got)
    {
        show(value);
    }
    std::printf("\n");
}

static void wait_for(const std::string &name)
{
    while (ros::ok() && !ros::param::has(name))
    {
        ros::Duration(0.05).sleep();
    }
}

// Until the value that is kept has changed.
static void wait_cached(ros::NodeHandle &nh, const std::string &name, int value)
{
    int now = -1;
    for (int tries = 0; tries < 100 && ros::ok() && !(nh.getParamCached(name, now) && now == value); ++tries)
    {
        ros::Duration(0.05).sleep();
    }
    std::printf("P| cached %s is %d\n", name.c_str(), now);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "shared_params");
    std::printf("P| before the start %d\n", ros::param::has("/absent"));
    ros::NodeHandle nh, own("~");
    int             absent = 5;
    std::printf("P| cached absent %d %d\n", nh.getParamCached("/late", absent), absent);

    own.setParam("int", 42);
    own.setParam("least", std::numeric_limits<int>::min());
    own.setParam("double", 0.1);
    own.setParam("whole", 4.0);
    own.setParam("tiny", 1e-300);
    own.setParam("bool", true);
    own.setParam("text", std::string("two words"));
    own.setParam("digits", "007");
    own.setParam("marks", "<a> & \"b\" 'c' \\ {x} [y]");
    own.setParam("empty", "");
    own.setParam("lines", "one\ntwo\tthree");
    own.setParam("unicode", "gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x9a\x80");
    own.setParam("list", std::vector<int>{3, 1, 2});
    own.setParam("texts", std::vector<std::string>{"a", "1", "true"});
    own.setParam("nothing", std::vector<double>());
    own.setParam("map", std::map<std::string, double>{{"p", 0.5}, {"i", 2}});
    Value mixed;
    mixed["on"]           = true;
    mixed["gains"][0]     = 1;
    mixed["gains"][1]     = 2.5;
    mixed["deep"]["name"] = "x";
    own.setParam("mixed", mixed);
    char bytes[]    = "\x00\x01\xfe\xff?";
    std::tm date    = {};
    date.tm_year    = 2026, date.tm_mon = 11, date.tm_mday = 23, date.tm_hour = 17, date.tm_min = 5;
    Value with_bytes;
    with_bytes["!!binary"] = "looks like it";
    own.setParam("bytes", Value(bytes, 5));
    own.setParam("no_bytes", Value(bytes, 0));
    own.setParam("date", Value(&date));
    own.setParam("like", with_bytes);
    date.tm_year = 126;
    own.setParam("short_date", Value(&date));
    Value held;
    held["in"][0] = Value(bytes, 2);
    held["in"][1] = Value(&date);
    own.setParam("held", held);
    ros::param::set("/from_cpp", 1);
    ros::param::set("/done_cpp", true);

    wait_for("/done_py");
    for (const char *name : {"int", "least", "double", "whole", "bool", "text", "digits", "marks", "empty", "lines", "unicode",
                             "list", "texts", "nothing", "tree", "tuple", "bytes", "none", "date", "like", "held", "big", "absent"})
    {
        read(std::string("/py/") + name);
    }
    read("/py");
    read("/probes/probe/short_date");
    std::printf("P| gone %d\n", ros::param::has("/from_cpp"));
    std::printf("P| type of digits %d\n", ros::param::param("/py/digits", 5));
    std::string found;
    std::printf("P| search %d", nh.searchParam("shared", found));
    std::printf(" %s\n", found.c_str());
    std::vector<std::string> names;
    nh.getParamNames(names);
    int of_py = 0;
    for (const std::string &name : names)
    {
        of_py += name.compare(0, 4, "/py/") == 0;
    }
    std::printf("P| names of /py: %d\n", of_py);
    wait_cached(nh, "/late", 1);
    ros::param::set("/seen", 1);
    wait_cached(nh, "/late", 2);
    ros::param::set("/seen", 2);
    wait_cached(nh, "/tree/in/it", 3);
    int kept = 0;
    ros::param::set("/late", 9);
    const bool its_own = nh.getParamCached("/late", kept);
    std::printf("P| its own %d %d\n", its_own, kept);
    const bool first = nh.deleteParam("/py/int"), again = nh.deleteParam("/py/int");
    std::printf("P| delete %d %d\n", first, again);
    ros::param::set("/seen", 3);
    wait_for("/end");
}
