// pluginlib::ClassLoader, for the classes of the node's own shared object.
#ifndef ROSCFE_PLUGINLIB_CLASS_LOADER_H
#define ROSCFE_PLUGINLIB_CLASS_LOADER_H

#include <stdexcept>
#include <string>
#include <vector>

#include <boost/shared_ptr.hpp>

#include "roscfe/plugins.h"
#include "roscfe/refuse.h"

namespace pluginlib
{

class PluginlibException : public std::runtime_error
{
  public:
    explicit PluginlibException(const std::string &what) : std::runtime_error(what) {}
};
class CreateClassException : public PluginlibException
{
    using PluginlibException::PluginlibException;
};
class LibraryLoadException : public PluginlibException
{
    using PluginlibException::PluginlibException;
};

template <class T>
class ClassLoader
{
  public:
    ClassLoader(const std::string &, const std::string &) {}

    // A class by its name in the plugin file ("package/Class") or in the source ("package::Class").
    boost::shared_ptr<T> createInstance(const std::string &name)
    {
        return boost::shared_ptr<T>(createUnmanagedInstance(name));
    }
    T *createUnmanagedInstance(const std::string &name)
    {
        T *made = make(name);
        if (made == nullptr)
        {
            ROSCFE_THROW(CreateClassException("class " + name + " is not in this node's shared object"));
        }
        return made;
    }

    bool isClassAvailable(const std::string &name)
    {
        for (const std::string &each : getDeclaredClasses())
        {
            if (each == name || each == in_source(name))
            {
                return true;
            }
        }
        return false;
    }
    std::vector<std::string> getDeclaredClasses()
    {
        std::vector<std::string> found;
        for (auto *entry = roscfe::Plugins<T>::first(); entry != nullptr; entry = entry->next)
        {
            found.push_back(entry->type);
        }
        return found;
    }

  private:
    static std::string in_source(const std::string &name)
    {
        const std::size_t slash = name.find('/');
        return slash == std::string::npos ? name : name.substr(0, slash) + "::" + name.substr(slash + 1);
    }
    static T *make(const std::string &name)
    {
        T *made = roscfe::Plugins<T>::make(name.c_str());
        return made != nullptr ? made : roscfe::Plugins<T>::make(in_source(name).c_str());
    }
};

} // namespace pluginlib

#endif
