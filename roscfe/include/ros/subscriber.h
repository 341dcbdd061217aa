// ros::Subscriber: CFE_SB_Subscribe for the node's pipe.
#ifndef ROS_SUBSCRIBER_H
#define ROS_SUBSCRIBER_H

#include <string>

#include "ros/forwards.h"
#include "roscfe/subscription.h"

namespace ros
{

class Subscriber
{
  public:
    Subscriber() = default;
    explicit Subscriber(const boost::shared_ptr<roscfe::Subscription> &subscription);

    void          shutdown();
    std::string   getTopic() const;
    std::uint32_t getNumPublishers() const; // 1 while subscribed: the Software Bus does not know senders

    explicit operator bool() const { return handle_ && handle_->subscription; }
    operator void *() const { return *this ? const_cast<void *>(static_cast<const void *>(handle_.get())) : nullptr; }
    bool operator<(const Subscriber &other) const { return handle_ < other.handle_; }
    bool operator==(const Subscriber &other) const { return handle_ == other.handle_; }
    bool operator!=(const Subscriber &other) const { return handle_ != other.handle_; }

  private:
    struct Handle
    {
        explicit Handle(const boost::shared_ptr<roscfe::Subscription> &of);
        ~Handle() { release(); }
        void                                    release();
        boost::shared_ptr<roscfe::Subscription> subscription;
        const std::string                       topic; // which stays when the subscriber is shut down
    };
    boost::shared_ptr<Handle> handle_;
};

} // namespace ros

#endif
