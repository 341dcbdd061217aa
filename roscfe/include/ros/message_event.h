// A received message with what is known of its way.
#ifndef ROS_MESSAGE_EVENT_H
#define ROS_MESSAGE_EVENT_H

#include <string>
#include <type_traits>

#include "ros/forwards.h"
#include "ros/time.h"

namespace ros
{

// A packet does not say who sent it: the publisher's name is "unknown_publisher", and the connection header has the type
// alone, and only of messages that a node reads by itself, such as topic_tools::ShapeShifter.
template <class M>
class MessageEvent
{
  public:
    typedef typename std::remove_const<M>::type Message;
    typedef Message const                       ConstMessage;
    typedef boost::shared_ptr<Message>          MessagePtr;
    typedef boost::shared_ptr<ConstMessage>     ConstMessagePtr;

    MessageEvent() = default;
    MessageEvent(const ConstMessagePtr &message) : message_(message), receipt_time_(Time::now()) {}
    MessageEvent(const ConstMessagePtr &message, Time receipt_time) : message_(message), receipt_time_(receipt_time) {}
    MessageEvent(const ConstMessagePtr &message, const M_stringPtr &connection_header, Time receipt_time)
        : message_(message), receipt_time_(receipt_time), connection_header_(connection_header)
    {
    }
    MessageEvent(const MessageEvent<Message> &other)
        : message_(other.getConstMessage()), receipt_time_(other.getReceiptTime()),
          connection_header_(other.getConnectionHeaderPtr())
    {
    }
    MessageEvent(const MessageEvent<ConstMessage> &other)
        : message_(other.getConstMessage()), receipt_time_(other.getReceiptTime()),
          connection_header_(other.getConnectionHeaderPtr())
    {
    }
    MessageEvent &operator=(const MessageEvent &) = default;

    // Each subscription has messages of its own, so a callback that may change one gets it without a copy.
    boost::shared_ptr<M>   getMessage() const { return boost::const_pointer_cast<Message>(message_); }
    const ConstMessagePtr &getConstMessage() const { return message_; }
    std::string            getPublisherName() const { return "unknown_publisher"; }
    Time                   getReceiptTime() const { return receipt_time_; }
    bool                   nonConstWillCopy() const { return false; }
    bool                   getMessageWillCopy() const { return false; }

    M_string &getConnectionHeader() const
    {
        static M_string empty;
        return connection_header_ ? *connection_header_ : empty;
    }
    const M_stringPtr &getConnectionHeaderPtr() const { return connection_header_; }

    bool operator<(const MessageEvent &other) const
    {
        return message_ != other.message_ ? message_ < other.message_ : receipt_time_ < other.receipt_time_;
    }
    bool operator==(const MessageEvent &other) const
    {
        return message_ == other.message_ && receipt_time_ == other.receipt_time_;
    }
    bool operator!=(const MessageEvent &other) const { return !(*this == other); }

  private:
    ConstMessagePtr message_;
    Time            receipt_time_;
    M_stringPtr     connection_header_;
};

} // namespace ros

#endif
