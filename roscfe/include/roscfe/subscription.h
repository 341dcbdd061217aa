// A subscription: messages that have come wait in it for their callback, and the oldest makes room when it is full.
#ifndef ROSCFE_SUBSCRIPTION_H
#define ROSCFE_SUBSCRIPTION_H

#include <cstdint>
#include <string>
#include <vector>

#include "ros/callback_queue_interface.h"
#include "ros/message_event.h"
#include "ros/serialization.h"
#include "roscfe/ground.h"
#include "roscfe/parts.h"
#include "roscfe/slots.h"
#include "roscfe/wire.h"

namespace roscfe
{

class Subscription : public ros::CallbackInterface
{
  public:
    Subscription(const std::string &topic, std::uint32_t queue, ros::CallbackQueueInterface *callbacks,
                 std::size_t most_bytes)
        : topic_(topic), queue_(queue), callbacks_(callbacks), most_bytes_(most_bytes)
    {
    }

    // Take the bytes of a message; true when one more callback is due.
    virtual bool receive(const std::uint8_t *bytes, std::size_t size) = 0;

    const std::string            topic_;
    const std::uint32_t          queue_;
    ros::CallbackQueueInterface *callbacks_;
    const std::size_t            most_bytes_; // of a message; 0 when nobody knows
    std::uint16_t                msg_id_  = 0;
    bool                         alive_   = true;
    bool                         raw_     = false;
    std::uint8_t                 number_  = 0; // among those of the node to its topic; the first is 0
    std::uint32_t                dropped_ = 0; // messages for which there was no room
    std::uint32_t                bad_     = 0; // packets that were no message of the type
};

// The subscription is part of the node from now on: MsgId, SB subscription, room in its callback queue.
void subscribe(const boost::shared_ptr<Subscription> &subscription, const char *type, const char *md5,
               const char *definition);
void unsubscribe(const boost::shared_ptr<Subscription> &subscription);

// How many messages a subscription keeps when the node asks for so many; 0 asks for all.
std::uint32_t queue_size(std::uint32_t asked);

// What is known of the messages of a topic, with the names that roscpp's connections have for it: type, md5sum,
// message_definition, latching, topic, callerid. It is asked for once.
ros::M_stringPtr connection_header(const std::string &topic);

template <class M>
class TypedSubscription final : public Subscription
{
  public:
    typedef ros::MessageEvent<M const>            Event;
    typedef boost::function<void(const Event &)> Callback;

    TypedSubscription(const std::string &topic, std::uint32_t queue, ros::CallbackQueueInterface *callbacks,
                      const Callback &callback, const ros::VoidConstPtr &tracked)
        : Subscription(topic, queue, callbacks, wire::most_bytes<M>()),
          callback_(callback),
          slots_(boost::make_shared<Slots<M>>(queue + kKept)),
          ring_(queue),
          tracked_(tracked),
          has_tracked_(tracked != nullptr)
    {
        parts::need_room<wire::most_bytes<M>()>();
    }

    bool receive(const std::uint8_t *bytes, std::size_t size) override
    {
        bool more = count_ < queue_;
        if (!more || !slots_->any())
        {
            ++dropped_;
            ++g_counters.dropped;
            if (count_ == 0)
            {
                return false; // the node holds all messages that there are
            }
            drop_oldest();
            more = false;
        }
        boost::shared_ptr<M> message = Slots<M>::take(slots_);
        if (!wire::read(*message, bytes, size))
        {
            ++bad_;
            ++g_counters.bad;
            return false;
        }
        ring_[(head_ + count_) % queue_] = Event(message, ros::Time::now());
        ++count_;
        ++g_counters.received;
        return more;
    }

    CallResult call() override
    {
        if (count_ == 0)
        {
            return Invalid; // a message was dropped, or the packet behind it was none
        }
        Event event = ring_[head_];
        drop_oldest();
        ros::VoidConstPtr held = tracked_.lock();
        if (alive_ && (!has_tracked_ || held))
        {
            if constexpr (!wire::HasFields<M>::value)
            {
                event = with_header(event);
            }
            callback_(event);
        }
        return Success;
    }

  private:
    static constexpr std::uint32_t kKept = 4; // messages that the node may hold beside those that wait

    // A type that reads by itself is told what the message is.
    Event with_header(const Event &event) const
    {
        ros::serialization::PreDeserializeParams<M> params;
        params.message           = boost::const_pointer_cast<M>(event.getConstMessage());
        params.connection_header = connection_header(topic_);
        ros::serialization::PreDeserialize<M>::notify(params);
        return Event(event.getConstMessage(), params.connection_header, event.getReceiptTime());
    }

    void drop_oldest()
    {
        ring_[head_] = Event();
        head_        = (head_ + 1) % queue_;
        --count_;
    }

    Callback                    callback_;
    boost::shared_ptr<Slots<M>> slots_;
    std::vector<Event>          ring_;
    ros::VoidConstWPtr          tracked_;
    bool                        has_tracked_;
    std::uint32_t               head_  = 0;
    std::uint32_t               count_ = 0;
};

} // namespace roscfe

#endif
