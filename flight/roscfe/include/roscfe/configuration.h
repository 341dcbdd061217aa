// Parameters that are changed at run time, without their types: what dynamic_reconfigure's server and messages need.
#ifndef ROSCFE_CONFIGURATION_H
#define ROSCFE_CONFIGURATION_H

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "dynamic_reconfigure/Config.h"
#include "dynamic_reconfigure/ConfigDescription.h"
#include "ros/node_handle.h"

namespace roscfe
{

// What a generated configuration says of one of its parameters.
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
    void operator()(int &field, const ConfigParameter<int> &p) { field = std::min(std::max(field, p.least), p.most); }
    void operator()(double &field, const ConfigParameter<double> &p)
    {
        field = std::min(std::max(field, p.least), p.most);
    }
    void operator()(bool &, const ConfigParameter<bool> &) {}
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

struct FromMessage
{
    const dynamic_reconfigure::Config &message;

    template <class L, class T>
    static void get(const L &list, const char *name, T &field)
    {
        for (const auto &each : list)
        {
            if (each.name == name)
            {
                field = static_cast<T>(each.value);
            }
        }
    }
    void operator()(bool &field, const ConfigParameter<bool> &p) { get(message.bools, p.name, field); }
    void operator()(int &field, const ConfigParameter<int> &p) { get(message.ints, p.name, field); }
    void operator()(double &field, const ConfigParameter<double> &p) { get(message.doubles, p.name, field); }
    void operator()(std::string &field, const ConfigParameter<const char *> &p)
    {
        for (const auto &each : message.strs)
        {
            if (each.name == p.name)
            {
                field = each.value.c_str();
            }
        }
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
    for (int i = 0; i < Config::group_count(); ++i)
    {
        const ConfigGroup &group = Config::groups_of()[i];
        message.groups.emplace_back();
        message.groups.back().name   = group.name;
        message.groups.back().state  = group.state;
        message.groups.back().id     = group.id;
        message.groups.back().parent = group.parent;
    }
    return message;
}

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
    Config::visit(SetMost(), config);
    message.max = message_of(config);
    Config::visit(SetLeast(), config);
    message.min = message_of(config);
    Config::visit(SetDefaults(), config);
    message.dflt = message_of(config);
    return message;
}

} // namespace configuration
} // namespace roscfe

#endif
