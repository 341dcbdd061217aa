// message_filters::Subscriber: a subscription as the beginning of filters.
#ifndef ROSCFE_MESSAGE_FILTERS_SUBSCRIBER_H
#define ROSCFE_MESSAGE_FILTERS_SUBSCRIBER_H

#include <string>

#include "message_filters/simple_filter.h"
#include "ros/ros.h"

namespace message_filters
{

class SubscriberBase
{
  public:
    virtual ~SubscriberBase() = default;
    virtual void subscribe(ros::NodeHandle &node, const std::string &topic, std::uint32_t queue_size,
                           const ros::TransportHints &  hints = ros::TransportHints(),
                           ros::CallbackQueueInterface *queue = nullptr) = 0;
    virtual void subscribe()                                             = 0;
    virtual void unsubscribe()                                           = 0;
};
typedef boost::shared_ptr<SubscriberBase> SubscriberBasePtr;

template <class M>
class Subscriber : public SubscriberBase, public SimpleFilter<M>
{
  public:
    typedef boost::shared_ptr<M const> MConstPtr;
    typedef ros::MessageEvent<M const> EventType;

    Subscriber() = default;
    ROSCFE_SUBSCRIBES Subscriber(ros::NodeHandle &node, const std::string &topic, std::uint32_t queue_size,
                                 const ros::TransportHints &hints = ros::TransportHints(), ros::CallbackQueueInterface *queue = nullptr)
    {
        subscribe(node, topic, queue_size, hints, queue);
    }
    ~Subscriber() override { subscriber_.shutdown(); }
    Subscriber(const Subscriber &) = delete;
    Subscriber &operator=(const Subscriber &) = delete;

    ROSCFE_SUBSCRIBES void subscribe(ros::NodeHandle &node, const std::string &topic, std::uint32_t queue_size,
                                     const ros::TransportHints &  hints = ros::TransportHints(),
                                     ros::CallbackQueueInterface *queue = nullptr) override
    {
        unsubscribe();
        if (topic.empty())
        {
            return;
        }
        options_ = ros::SubscribeOptions();
        options_.template initByFullCallbackType<const EventType &>(
            topic, queue_size,
            boost::function<void(const EventType &)>([this](const EventType &event) { this->signalMessage(event); }));
        options_.callback_queue  = queue;
        options_.transport_hints = hints;
        node_                    = node;
        subscribe();
    }
    void subscribe() override
    {
        unsubscribe();
        if (!options_.topic.empty())
        {
            subscriber_ = node_.subscribe(options_);
        }
    }
    void unsubscribe() override { subscriber_.shutdown(); }

    std::string            getTopic() const { return options_.topic; }
    const ros::Subscriber &getSubscriber() const { return subscriber_; }

    // It is a beginning: it takes no input from other filters.
    template <class F>
    void connectInput(F &)
    {
    }
    void add(const EventType &) {}

  private:
    ros::NodeHandle       node_;
    ros::SubscribeOptions options_;
    ros::Subscriber       subscriber_;
};

} // namespace message_filters

#endif
