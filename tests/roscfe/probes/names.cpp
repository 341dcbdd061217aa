// How names are resolved, remapped, cleaned and refused.
#include <cstdio>

#include <ros/ros.h>

template <class Function>
void print(const char *expression, Function function)
{
    std::string text;
    try
    {
        text = function();
    }
    catch (const ros::InvalidNameException &error)
    {
        text = std::string("InvalidNameException ") + error.what();
    }
    std::printf("P| %s: %s\n", expression, text.c_str());
}

#define PRINT(expression) print(#expression, [&]() -> std::string { return expression; })

static void validate(const char *name)
{
    std::string error;
    const bool  good = ros::names::validate(name, error);
    std::printf("P| validate(%s): %d %s\n", name, good, error.c_str());
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "names");
    ros::NodeHandle nh, own("~"), sub("sub"), global("/"), inner(sub, "inner"), inner_own(own, "deep");
    ros::M_string   remappings;
    remappings["left"] = "right";
    ros::NodeHandle remapping("ns", remappings);
    PRINT(ros::this_node::getName());
    PRINT(ros::this_node::getNamespace());
    for (const std::string name : {"", "a", "/a", "~a", "a/b", "a//b", "a b", "1a", "_a", "a1_", "a~b", "a-b", "/", "//", "/1", "a/"})
    {
        validate(name.c_str());
        std::printf("P| of %s\n", name.c_str());
        PRINT(ros::names::resolve(name));
        PRINT(ros::names::resolve(name, false));
        PRINT(ros::names::resolve("/other", name));
        PRINT(ros::names::resolve("other", name));
        PRINT(ros::names::clean(name));
        PRINT(ros::names::append("x", name));
        PRINT(ros::names::append(name, "x"));
        PRINT(ros::names::remap(name));
        PRINT(ros::names::parentNamespace(name));
        PRINT(nh.resolveName(name));
        PRINT(own.resolveName(name));
        PRINT(sub.resolveName(name));
        PRINT(global.resolveName(name, false));
        PRINT(inner.resolveName(name));
        PRINT(ros::NodeHandle(name).getNamespace());
        PRINT(ros::NodeHandle(sub, name).getNamespace());
    }
    PRINT(ros::names::resolve("from"));
    PRINT(ros::names::resolve("from", false));
    PRINT(ros::names::resolve("/probes/from"));
    PRINT(nh.resolveName("from"));
    PRINT(nh.resolveName("from", false));
    PRINT(sub.resolveName("from"));
    PRINT(remapping.resolveName("left"));
    PRINT(remapping.resolveName("left", false));
    PRINT(remapping.resolveName("/probes/ns/left"));
    PRINT(ros::NodeHandle(remapping, "more").resolveName("left"));
    PRINT(ros::NodeHandle(remapping).resolveName("left"));
    PRINT(inner.getUnresolvedNamespace());
    PRINT(inner_own.getNamespace());
    PRINT(inner_own.getUnresolvedNamespace());
    PRINT(own.getUnresolvedNamespace());
    for (const auto &each : ros::names::getRemappings())
    {
        std::printf("P| remapping %s to %s\n", each.first.c_str(), each.second.c_str());
    }
    return 0;
}
