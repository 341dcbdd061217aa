// dynamic_reconfigure::Server: parameters of a node that others change while it runs.
#ifndef ROSCFE_DYNAMIC_RECONFIGURE_SERVER_H
#define ROSCFE_DYNAMIC_RECONFIGURE_SERVER_H

#include "dynamic_reconfigure/Reconfigure.h"
#include "roscfe/configuration.h"

namespace dynamic_reconfigure
{

template <class ConfigType>
class Server
{
  public:
    typedef boost::function<void(ConfigType &, std::uint32_t level)> CallbackType;

    explicit Server(const ros::NodeHandle &node = ros::NodeHandle("~")) : node_(node) { begin(); }
    // With a mutex of the node's, which nothing contends for: all callbacks run in one task.
    template <class Mutex>
    explicit Server(Mutex &, const ros::NodeHandle &node = ros::NodeHandle("~")) : node_(node)
    {
        begin();
    }
    Server(const Server &) = delete;
    Server &operator=(const Server &) = delete;

    // It is called at once with all levels.
    void setCallback(const CallbackType &callback)
    {
        callback_ = callback;
        if (callback_)
        {
            callback_(config_, ~std::uint32_t(0));
        }
        update(config_);
    }
    void clearCallback() { callback_ = CallbackType(); }

    // The node's own changes: they are told, and the callback is not called.
    void updateConfig(const ConfigType &config) { update(config); }

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
        config_ = config;
        config_.__toServer__(node_);
        updates_.publish(roscfe::configuration::message_of(config_));
    }

    bool set(Reconfigure::Request &request, Reconfigure::Response &response)
    {
        ConfigType changed = config_;
        ConfigType::visit(roscfe::configuration::FromMessage{request.config}, changed);
        changed.__clamp__();
        const std::uint32_t level = changed.__level__(config_);
        if (callback_)
        {
            callback_(changed, level);
        }
        update(changed);
        response.config = roscfe::configuration::message_of(config_);
        return true;
    }

    ros::NodeHandle    node_;
    ConfigType         config_;
    ConfigType         least_;
    ConfigType         most_;
    ConfigType         otherwise_;
    CallbackType       callback_;
    ros::ServiceServer service_;
    ros::Publisher     updates_;
    ros::Publisher     description_;
};

} // namespace dynamic_reconfigure

#endif
