// What nodes ask of their publishers and subscribers.
#include "core/core.h"
#include "ros/publisher.h"
#include "ros/subscriber.h"
#include "roscfe/parts.h"

namespace ros
{

void Publisher::shutdown()
{
    if (handle_)
    {
        handle_->release();
        handle_.reset(); // its copies still have the topic's name
    }
}

std::string Publisher::getTopic() const
{
    return handle_ ? handle_->topic : std::string();
}

std::uint32_t Publisher::getNumSubscribers() const
{
    if (!*this)
    {
        return 0;
    }
    roscfe::pump(0); // a loop that waits for subscribers hears of them
    roscfe::parts::need(roscfe::parts::subscribers);
    const std::uint16_t msg_id = handle_->advertised->publication_->msg_id_;
    return roscfe::g_node.knows_subscribers || msg_id == 0 ? roscfe::pipes_on(msg_id) : 1;
}

bool Publisher::isLatched() const
{
    if (!*this) // an assertion of roscpp, which its library contains however the node is built
    {
        roscfe::refuse("isLatched() of a publisher that has no topic", roscfe::g_node.name.c_str());
    }
    return handle_->advertised->latch_;
}

void Subscriber::shutdown()
{
    if (handle_)
    {
        handle_->release();
    }
}

std::string Subscriber::getTopic() const
{
    return handle_ ? handle_->topic : std::string();
}

std::uint32_t Subscriber::getNumPublishers() const
{
    return *this ? 1 : 0;
}

} // namespace ros
