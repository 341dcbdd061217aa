// dynamic_reconfigure::Server: parameters of a node that others change while it runs.
#ifndef ROSCFE_DYNAMIC_RECONFIGURE_SERVER_H
#define ROSCFE_DYNAMIC_RECONFIGURE_SERVER_H

#include <exception>
#if defined(__cpp_exceptions)
#include <cxxabi.h>
#endif

#include <boost/thread/recursive_mutex.hpp>

#include "dynamic_reconfigure/Reconfigure.h"
#include "roscfe/configuration.h"

namespace dynamic_reconfigure
{

template <class ConfigType>
class Server
{
  public:
    typedef boost::function<void(ConfigType &, std::uint32_t level)> CallbackType;

    explicit Server(const ros::NodeHandle &node = ros::NodeHandle("~")) : node_(node), mutex_(own_mutex_)
    {
        begin();
    }
    // With a mutex of the node's, which is held while the callback runs.
    explicit Server(boost::recursive_mutex &mutex, const ros::NodeHandle &node = ros::NodeHandle("~"))
        : node_(node), mutex_(mutex), warns_(false)
    {
        begin();
    }
    Server(const Server &) = delete;
    Server &operator=(const Server &) = delete;

    // It is called at once with all levels.
    void setCallback(const CallbackType &callback)
    {
        const Lock lock(mutex_);
        callback_ = callback;
        call(config_, ~std::uint32_t(0));
        update(config_);
    }
    void clearCallback()
    {
        const Lock lock(mutex_);
        callback_ = CallbackType();
    }

    // The node's own changes: they are told, and the callback is not called.
    void updateConfig(const ConfigType &config)
    {
        if (warns_)
        {
            ROS_WARN("updateConfig() called on a dynamic_reconfigure::Server that provides its own mutex. This can "
                     "lead to deadlocks if updateConfig() is called during an update. Providing a mutex to the "
                     "constructor is highly recommended in this case. Please forward this message to the node "
                     "author.");
            warns_ = false;
        }
        update(config);
    }

    void getConfigMax(ConfigType &config) const { config = most_; }
    void getConfigMin(ConfigType &config) const { config = least_; }
    void getConfigDefault(ConfigType &config) const { config = otherwise_; }
    void setConfigMax(const ConfigType &config)
    {
        most_ = config;
        publish_description();
    }
    void setConfigMin(const ConfigType &config)
    {
        least_ = config;
        publish_description();
    }
    void setConfigDefault(const ConfigType &config)
    {
        otherwise_ = config;
        publish_description();
    }

  private:
    typedef boost::recursive_mutex::scoped_lock Lock;

    void begin()
    {
        ConfigType::visit(roscfe::configuration::SetLeast(), least_);
        ConfigType::visit(roscfe::configuration::SetMost(), most_);
        service_     = node_.advertiseService("set_parameters", &Server::set, this);
        description_ = node_.advertise<ConfigDescription>("parameter_descriptions", 1, true);
        updates_     = node_.advertise<Config>("parameter_updates", 1, true);
        publish_description();
        ConfigType first = otherwise_;
        first.__fromServer__(node_);
        first.__clamp__();
        update(first);
    }

    void publish_description()
    {
        ConfigDescription message = roscfe::configuration::description_of<ConfigType>();
        message.max               = roscfe::configuration::message_of(most_);
        message.min               = roscfe::configuration::message_of(least_);
        message.dflt              = roscfe::configuration::message_of(otherwise_);
        description_.publish(message);
    }

    void update(const ConfigType &config)
    {
        const Lock lock(mutex_);
        config_ = config;
        config_.__toServer__(node_);
        updates_.publish(roscfe::configuration::message_of(config_));
    }

    // What the callback throws is logged, and the configuration counts all the same.
    void call(ConfigType &config, std::uint32_t level)
    {
        if (!callback_)
        {
            return;
        }
#if defined(__cpp_exceptions)
        try
        {
            callback_(config, level);
        }
        catch (const abi::__forced_unwind &) // the end of the task
        {
            throw;
        }
        catch (const std::exception &exception)
        {
            ROS_WARN("Reconfigure callback failed with exception %s: ", exception.what());
        }
        catch (...)
        {
            ROS_WARN("Reconfigure callback failed with unprintable exception.");
        }
#else
        callback_(config, level);
#endif
    }

    bool set(Reconfigure::Request &request, Reconfigure::Response &response)
    {
        const Lock lock(mutex_);
        ConfigType changed = config_;
        changed.__fromMessage__(request.config);
        changed.__clamp__();
        const std::uint32_t level = changed.__level__(config_);
        call(changed, level);
        update(changed);
        response.config = roscfe::configuration::message_of(config_);
        return true;
    }

    ros::NodeHandle         node_;
    ConfigType              config_;
    ConfigType              least_;
    ConfigType              most_;
    ConfigType              otherwise_;
    CallbackType            callback_;
    ros::ServiceServer      service_;
    ros::Publisher          updates_;
    ros::Publisher          description_;
    boost::recursive_mutex  own_mutex_;
    boost::recursive_mutex &mutex_;
    bool                    warns_ = true; // without a mutex of the node's, of its own changes
};

} // namespace dynamic_reconfigure

#endif
