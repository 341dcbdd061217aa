// ros::param: parameters, which are those of cfepy's parameter server, or rows of the application's table (node.h).
#ifndef ROSCPP_PARAM_H
#define ROSCPP_PARAM_H

#include <map>
#include <string>
#include <vector>

#include "XmlRpcValue.h"
#include "ros/forwards.h"
#include "ros/names.h"
#include "roscfe/name.h"

namespace roscfe
{

// By their full names. What C++ asks for and what the parameter is must agree as in roscpp: an int is no string, but a
// double takes an int.
bool get_param(const std::string &name, XmlRpc::XmlRpcValue &value);
bool get_param_cached(const std::string &name, XmlRpc::XmlRpcValue &value); // asks again only after a change
void set_param(const std::string &name, const XmlRpc::XmlRpcValue &value);
bool has_param(const std::string &name);
bool delete_param(const std::string &name);
void param_names(std::vector<std::string> &names);
// The full name of a parameter, in memory that is used again for the next one: looking a name up allocates nothing.
const std::string &full_key(Name key);

bool search_param(const std::string &ns, const std::string &key, std::string &result);

bool param_to(XmlRpc::XmlRpcValue &value, std::string &to);
bool param_to(XmlRpc::XmlRpcValue &value, double &to);
bool param_to(XmlRpc::XmlRpcValue &value, float &to);
bool param_to(XmlRpc::XmlRpcValue &value, int &to);
bool param_to(XmlRpc::XmlRpcValue &value, bool &to);
bool param_to(XmlRpc::XmlRpcValue &value, XmlRpc::XmlRpcValue &to);

// An element of a list or of a map: numbers are converted freely, as roscpp does there.
bool element_to(XmlRpc::XmlRpcValue &value, std::string &to);
bool element_to(XmlRpc::XmlRpcValue &value, double &to);
bool element_to(XmlRpc::XmlRpcValue &value, float &to);
bool element_to(XmlRpc::XmlRpcValue &value, int &to);
bool element_to(XmlRpc::XmlRpcValue &value, bool &to);

template <class T>
bool param_to(XmlRpc::XmlRpcValue &value, std::vector<T> &to)
{
    if (value.getType() != XmlRpc::XmlRpcValue::TypeArray)
    {
        return false;
    }
    to.resize(static_cast<std::size_t>(value.size())); // and stays so when an element is of another type, as in roscpp
    for (int i = 0; i < value.size(); ++i)
    {
        T item{};
        if (!element_to(value[i], item))
        {
            return false;
        }
        to[static_cast<std::size_t>(i)] = item;
    }
    return true;
}

template <class T>
bool param_to(XmlRpc::XmlRpcValue &value, std::map<std::string, T> &to)
{
    if (value.getType() != XmlRpc::XmlRpcValue::TypeStruct)
    {
        return false;
    }
    for (auto &member : value) // others stay in the map, as in roscpp
    {
        T item{};
        if (!element_to(member.second, item))
        {
            return false;
        }
        to[member.first] = item;
    }
    return true;
}

inline XmlRpc::XmlRpcValue param_from(const XmlRpc::XmlRpcValue &value) { return value; }
inline XmlRpc::XmlRpcValue param_from(const std::string &value) { return XmlRpc::XmlRpcValue(value); }
inline XmlRpc::XmlRpcValue param_from(const char *value) { return XmlRpc::XmlRpcValue(value); }
inline XmlRpc::XmlRpcValue param_from(double value) { return XmlRpc::XmlRpcValue(value); }
inline XmlRpc::XmlRpcValue param_from(int value) { return XmlRpc::XmlRpcValue(value); }
inline XmlRpc::XmlRpcValue param_from(bool value) { return XmlRpc::XmlRpcValue(value); }

template <class T>
XmlRpc::XmlRpcValue param_from(const std::vector<T> &value)
{
    XmlRpc::XmlRpcValue made;
    made.setSize(static_cast<int>(value.size()));
    for (std::size_t i = 0; i < value.size(); ++i)
    {
        made[static_cast<int>(i)] = param_from(static_cast<T>(value[i]));
    }
    return made;
}

template <class T>
XmlRpc::XmlRpcValue param_from(const std::map<std::string, T> &value)
{
    XmlRpc::XmlRpcValue made;
    for (const auto &member : value)
    {
        made[member.first] = param_from(member.second);
    }
    return made;
}

} // namespace roscfe

namespace ros
{
namespace param
{

template <class T>
bool get(roscfe::Name key, T &value)
{
    XmlRpc::XmlRpcValue found;
    return roscfe::get_param(roscfe::full_key(key), found) && roscfe::param_to(found, value);
}
template <class T>
bool getCached(roscfe::Name key, T &value)
{
    XmlRpc::XmlRpcValue found;
    return roscfe::get_param_cached(roscfe::full_key(key), found) && roscfe::param_to(found, value);
}
template <class T>
bool param(roscfe::Name key, T &value, const T &otherwise)
{
    if (get(key, value))
    {
        return true;
    }
    value = otherwise;
    return false;
}
template <class T>
T param(roscfe::Name key, const T &otherwise)
{
    T value{};
    return get(key, value) ? value : otherwise;
}
template <class T>
void set(const std::string &key, const T &value)
{
    roscfe::set_param(names::resolve(key), roscfe::param_from(value));
}
inline void set(const std::string &key, const char *value)
{
    roscfe::set_param(names::resolve(key), roscfe::param_from(value));
}

bool has(roscfe::Name key);
bool del(const std::string &key);
bool search(const std::string &ns, const std::string &key, std::string &result);
bool search(const std::string &key, std::string &result);
bool getParamNames(std::vector<std::string> &keys);
inline void unsubscribeCachedParam() {}
inline void unsubscribeCachedParam(const std::string &) {}

} // namespace param
} // namespace ros

#endif
