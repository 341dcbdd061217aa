// All that a subscription may be told.
#ifndef ROS_SUBSCRIBE_OPTIONS_H
#define ROS_SUBSCRIBE_OPTIONS_H

#include <string>

#include "ros/forwards.h"
#include "ros/parameter_adapter.h"
#include "ros/transport_hints.h"
#include "roscfe/subscription.h"

// The check asks the compiler for the types of all calls that subscribe.
#ifdef ROSCFE_IS_CHECKED
#define ROSCFE_SUBSCRIBES [[deprecated("roscfe: it subscribes")]]
#else
#define ROSCFE_SUBSCRIBES
#endif

namespace ros
{

struct SubscribeOptions
{
    typedef boost::function<boost::shared_ptr<roscfe::Subscription>(const SubscribeOptions &, const std::string &,
                                                                    CallbackQueueInterface *)>
        Factory;

    SubscribeOptions() = default;

    // P is the callback's parameter.
    template <class P>
    ROSCFE_SUBSCRIBES void initByFullCallbackType(const std::string &_topic, std::uint32_t _queue_size,
                                const boost::function<void(P)> &_callback)
    {
        typedef ParameterAdapter<P>       Adapter;
        typedef typename Adapter::Message M;
        topic      = _topic;
        queue_size = _queue_size;
        type       = roscfe::wire::Traits<M>::type();
        md5sum     = roscfe::wire::Traits<M>::md5();
        definition = roscfe::wire::Traits<M>::definition();
        make       = [_callback](const SubscribeOptions &options, const std::string &resolved,
                           CallbackQueueInterface *queue) -> boost::shared_ptr<roscfe::Subscription> {
            return boost::make_shared<roscfe::TypedSubscription<M>>(
                resolved, roscfe::queue_size(options.queue_size), queue,
                [_callback](const typename Adapter::Event &event) { _callback(Adapter::getParameter(event)); },
                options.tracked_object);
        };
    }

    template <class M>
    ROSCFE_SUBSCRIBES void init(const std::string &_topic, std::uint32_t _queue_size,
              const boost::function<void(const boost::shared_ptr<M const> &)> &_callback)
    {
        initByFullCallbackType<const boost::shared_ptr<M const> &>(_topic, _queue_size, _callback);
    }

    template <class M>
    ROSCFE_SUBSCRIBES static SubscribeOptions create(const std::string &topic, std::uint32_t queue_size,
                                   const boost::function<void(const boost::shared_ptr<M const> &)> &callback,
                                   const VoidConstPtr &tracked_object, CallbackQueueInterface *queue)
    {
        SubscribeOptions options;
        options.init<M>(topic, queue_size, callback);
        options.tracked_object = tracked_object;
        options.callback_queue = queue;
        return options;
    }

    std::string             topic;
    std::uint32_t           queue_size = 0;
    std::string             md5sum;
    std::string             datatype;
    CallbackQueueInterface *callback_queue             = nullptr;
    bool                    allow_concurrent_callbacks = false;
    VoidConstPtr            tracked_object;
    TransportHints          transport_hints;

    const char *type       = "*";
    const char *definition = "";
    Factory     make; // of the subscription, by its resolved topic
};

} // namespace ros

#endif
