// ros::topic: waiting for one message.
#ifndef ROSCPP_TOPIC_H
#define ROSCPP_TOPIC_H

#include <string>

#include "ros/node_handle.h"

namespace ros
{
namespace topic
{

// The next message of a topic; null when it does not come in time. A time of 0 waits for ever.
template <class M>
boost::shared_ptr<M const> waitForMessage(const std::string &topic, NodeHandle &node, Duration timeout)
{
    boost::shared_ptr<M const> got;
    CallbackQueue              queue;
    SubscribeOptions           options = SubscribeOptions::create<M>(
        topic, 1,
        [&got](const boost::shared_ptr<M const> &message) {
            if (!got)
            {
                got = message;
            }
        },
        VoidConstPtr(), &queue);
    Subscriber subscriber = node.subscribe(options);
    const Time end        = Time::now() + timeout;
    while (!got && ok() && (timeout <= Duration(0.0) || Time::now() < end))
    {
        queue.callAvailable(WallDuration(0.1));
    }
    return got;
}
template <class M>
boost::shared_ptr<M const> waitForMessage(const std::string &topic)
{
    NodeHandle node;
    return waitForMessage<M>(topic, node, Duration());
}
template <class M>
boost::shared_ptr<M const> waitForMessage(const std::string &topic, Duration timeout)
{
    NodeHandle node;
    return waitForMessage<M>(topic, node, timeout);
}
template <class M>
boost::shared_ptr<M const> waitForMessage(const std::string &topic, NodeHandle &node)
{
    return waitForMessage<M>(topic, node, Duration());
}

} // namespace topic
} // namespace ros

#endif
