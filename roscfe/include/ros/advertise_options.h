// All that a publisher may be told.
#ifndef ROS_ADVERTISE_OPTIONS_H
#define ROS_ADVERTISE_OPTIONS_H

#include <string>

#include "ros/forwards.h"
#include "roscfe/wire.h"

namespace ros
{

struct AdvertiseOptions
{
    AdvertiseOptions() = default;
    AdvertiseOptions(const std::string &_topic, std::uint32_t _queue_size, const std::string &_md5sum,
                     const std::string &_datatype, const std::string &_message_definition,
                     const SubscriberStatusCallback &_connect_cb    = SubscriberStatusCallback(),
                     const SubscriberStatusCallback &_disconnect_cb = SubscriberStatusCallback())
        : topic(_topic), queue_size(_queue_size), md5sum(_md5sum), datatype(_datatype),
          message_definition(_message_definition), connect_cb(_connect_cb), disconnect_cb(_disconnect_cb)
    {
    }

    template <class M>
    void init(const std::string &_topic, std::uint32_t _queue_size,
              const SubscriberStatusCallback &_connect_cb    = SubscriberStatusCallback(),
              const SubscriberStatusCallback &_disconnect_cb = SubscriberStatusCallback())
    {
        topic              = _topic;
        queue_size         = _queue_size;
        connect_cb         = _connect_cb;
        disconnect_cb      = _disconnect_cb;
        md5sum             = roscfe::wire::Traits<M>::md5();
        datatype           = roscfe::wire::Traits<M>::type();
        message_definition = roscfe::wire::Traits<M>::definition();
        has_header         = roscfe::wire::Traits<M>::has_header;
        most_bytes         = roscfe::wire::most_bytes<M>();
    }

    template <class M>
    static AdvertiseOptions create(const std::string &topic, std::uint32_t queue_size,
                                   const SubscriberStatusCallback &connect_cb,
                                   const SubscriberStatusCallback &disconnect_cb, const VoidConstPtr &tracked_object,
                                   CallbackQueueInterface *queue)
    {
        AdvertiseOptions options;
        options.init<M>(topic, queue_size, connect_cb, disconnect_cb);
        options.tracked_object = tracked_object;
        options.callback_queue = queue;
        return options;
    }

    std::string              topic;
    std::uint32_t            queue_size = 0;
    std::string              md5sum;
    std::string              datatype;
    std::string              message_definition;
    SubscriberStatusCallback connect_cb;
    SubscriberStatusCallback disconnect_cb;
    CallbackQueueInterface * callback_queue = nullptr;
    VoidConstPtr             tracked_object;
    bool                     latch      = false;
    bool                     has_header = false;
    std::size_t              most_bytes = 0; // of a message; 0 when nobody knows
};

} // namespace ros

#endif
