// Parameters that are changed at run time, without their types: what dynamic_reconfigure's server and messages need.
#ifndef ROSCFE_CONFIGURATION_H
#define ROSCFE_CONFIGURATION_H

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "dynamic_reconfigure/Config.h"
#include "dynamic_reconfigure/ConfigDescription.h"
#include "ros/console.h"
#include "ros/node_handle.h"

namespace roscfe
{

// What a generated configuration says of one of its parameters; `group` counts groups as they are described.
template <class T>
struct ConfigParameter
{
    const char *  name;
    const char *  type;
    std::uint32_t level;
    const char *  description;
    const char *  edit_method;
    T             otherwise;
    T             least;
    T             most;
    int           group;
};

struct ConfigGroup
{
    const char *name;
    const char *type;
    int         parent;
    int         id;
    bool        state;
};

namespace configuration
{

// Visitors of the parameters of a configuration: Config::visit(visitor, config) calls one with each field.

struct SetDefaults
{
    template <class T, class D>
    void operator()(T &field, const ConfigParameter<D> &parameter)
    {
        field = parameter.otherwise;
    }
};

struct SetLeast
{
    template <class T, class D>
    void operator()(T &field, const ConfigParameter<D> &parameter)
    {
        field = parameter.least;
    }
};

struct SetMost
{
    template <class T, class D>
    void operator()(T &field, const ConfigParameter<D> &parameter)
    {
        field = parameter.most;
    }
};

struct Clamp
{
    template <class T>
    void operator()(T &field, const ConfigParameter<T> &p)
    {
        field = std::min(std::max(field, p.least), p.most);
    }
    void operator()(std::string &, const ConfigParameter<const char *> &) {}
};

struct FromServer
{
    const ros::NodeHandle &node;
    template <class T, class D>
    void operator()(T &field, const ConfigParameter<D> &parameter)
    {
        node.getParam(parameter.name, field);
    }
};

struct ToServer
{
    const ros::NodeHandle &node;
    template <class T, class D>
    void operator()(T &field, const ConfigParameter<D> &parameter)
    {
        node.setParam(parameter.name, field);
    }
};

struct ToMessage
{
    dynamic_reconfigure::Config &message;

    template <class L, class T>
    static void put(L &list, const char *name, const T &value)
    {
        list.emplace_back();
        list.back().name  = name;
        list.back().value = value;
    }
    void operator()(bool &field, const ConfigParameter<bool> &p) { put(message.bools, p.name, field); }
    void operator()(int &field, const ConfigParameter<int> &p) { put(message.ints, p.name, field); }
    void operator()(double &field, const ConfigParameter<double> &p) { put(message.doubles, p.name, field); }
    void operator()(std::string &field, const ConfigParameter<const char *> &p)
    {
        put(message.strs, p.name, field.c_str());
    }
};

// Counts the parameters that the message has. Of two values for one the first counts.
struct FromMessage
{
    const dynamic_reconfigure::Config &message;
    std::size_t &                      found;

    template <class L, class T>
    void get(const L &list, const char *name, T &field)
    {
        for (const auto &each : list)
        {
            if (each.name == name)
            {
                put(field, each.value);
                ++found;
                return;
            }
        }
    }
    template <class T, class V>
    static void put(T &field, const V &value)
    {
        field = static_cast<T>(value);
    }
    template <class V>
    static void put(std::string &field, const V &value)
    {
        field.assign(value.data(), value.size());
    }
    void operator()(bool &field, const ConfigParameter<bool> &p) { get(message.bools, p.name, field); }
    void operator()(int &field, const ConfigParameter<int> &p) { get(message.ints, p.name, field); }
    void operator()(double &field, const ConfigParameter<double> &p) { get(message.doubles, p.name, field); }
    void operator()(std::string &field, const ConfigParameter<const char *> &p) { get(message.strs, p.name, field); }
};

// Visitors of the groups of a configuration, an outer one before those inside: Config::visit_groups(visitor, config).

struct InitialState
{
    void operator()(bool &state, const ConfigGroup &group) { state = group.state; }
};

struct GroupToMessage
{
    dynamic_reconfigure::Config &message;
    void operator()(bool &state, const ConfigGroup &group)
    {
        message.groups.emplace_back();
        message.groups.back().name   = group.name;
        message.groups.back().state  = state;
        message.groups.back().id     = group.id;
        message.groups.back().parent = group.parent;
    }
};

// As in ROS, the first group that the message does not have keeps those behind it as they are.
struct GroupFromMessage
{
    const dynamic_reconfigure::Config &message;
    bool &                             is_over;
    void operator()(bool &state, const ConfigGroup &group)
    {
        for (std::size_t i = 0; !is_over && i < message.groups.size(); ++i)
        {
            if (message.groups[i].name == group.name)
            {
                state = message.groups[i].state;
                return;
            }
        }
        is_over = true;
    }
};

struct Describe
{
    dynamic_reconfigure::ConfigDescription &message;
    template <class T, class D>
    void operator()(T &, const ConfigParameter<D> &parameter)
    {
        auto &list = message.groups[static_cast<std::size_t>(parameter.group)].parameters;
        list.emplace_back();
        list.back().name        = parameter.name;
        list.back().type        = parameter.type;
        list.back().level       = parameter.level;
        list.back().description = parameter.description;
        list.back().edit_method = parameter.edit_method;
    }
};

// The levels of the parameters in which two configurations differ. The fields come in the same order.
template <class Config>
std::uint32_t levels_between(Config &one, Config &other)
{
    std::uint32_t level = 0;
    Config::visit_both(
        [&level](const auto &a, const auto &b, const auto &parameter) {
            if (!(a == b))
            {
                level |= parameter.level;
            }
        },
        one, other);
    return level;
}

template <class Config>
dynamic_reconfigure::Config message_of(const Config &config)
{
    dynamic_reconfigure::Config message;
    Config                      copy = config;
    Config::visit(ToMessage{message}, copy);
    Config::visit_groups(GroupToMessage{message}, copy);
    return message;
}

template <class List>
void log_names(const char *title, const List &list)
{
    ROS_ERROR("%s:", title);
    for (const auto &each : list)
    {
        ROS_ERROR("  %s", each.name.c_str());
    }
}

// Take over what a message has; false, with lines in the log, when it has other parameters, too, or one twice.
template <class Config>
bool take(const dynamic_reconfigure::Config &message, Config &config, const char *name)
{
    std::size_t found   = 0;
    bool        is_over = false;
    Config::visit(FromMessage{message, found}, config);
    Config::visit_groups(GroupFromMessage{message, is_over}, config);
    if (found == message.bools.size() + message.ints.size() + message.doubles.size() + message.strs.size())
    {
        return true;
    }
    ROS_ERROR("%s::__fromMessage__ called with an unexpected parameter.", name);
    log_names("Booleans", message.bools);
    log_names("Integers", message.ints);
    log_names("Doubles", message.doubles);
    log_names("Strings", message.strs);
    return false;
}

// Groups and their parameters, without limits and defaults.
template <class Config>
dynamic_reconfigure::ConfigDescription description_of()
{
    dynamic_reconfigure::ConfigDescription message;
    for (int i = 0; i < Config::group_count(); ++i)
    {
        const ConfigGroup &group = Config::groups_of()[i];
        message.groups.emplace_back();
        message.groups.back().name   = group.name;
        message.groups.back().type   = group.type;
        message.groups.back().parent = group.parent;
        message.groups.back().id     = group.id;
    }
    Config config;
    Config::visit(Describe{message}, config);
    return message;
}

} // namespace configuration
} // namespace roscfe

#endif
