// Publishers and subscribers: what a node makes of them, and their life.
#include <algorithm>
#include <cstring>

#include "core.h"
#include "ros/advertise_options.h"
#include "ros/node_handle.h"
#include "roscfe/refuse.h"

namespace roscfe
{

Registration enroll_topic(Kind kind, const std::string &name, const char *type, const char *md5, const char *definition)
{
    Registration place;
    if (enroll_with_master != nullptr && enroll_with_master(kind, name, type, md5, definition, place))
    {
        return place;
    }
    for (int i = 0; i < g_node.description->topic_count; ++i)
    {
        const TopicId &topic = g_node.description->topics[i];
        if (name == topic.name)
        {
            place.msg_id = topic.msg_id;
            place.raw    = topic.raw;
            return place;
        }
    }
    if (name == "/rosout")
    {
        place.msg_id = kRosoutMsgId;
        return place;
    }
    refuse("no MsgId for the topic; write it in the mission file's topics", name.c_str());
}

namespace
{

void withdraw_topic(Kind kind, const std::string &topic)
{
    if (withdraw_name != nullptr)
    {
        withdraw_name(kind, topic);
    }
}

// Messages that are written onto the bus itself need no other memory.
bool is_long(const Publication &publication, bool latch, std::size_t size)
{
    return latch || publication.raw_ || size > kRoom;
}

void need_part(const void *part, const std::string &topic)
{
    if (part == nullptr)
    {
        refuse("the image has no long_messages.cpp, which the topic needs", topic.c_str());
    }
}

} // namespace

// -- publishers --------------------------------------------------------------------------------------------------------

boost::shared_ptr<Publication> advertise(const std::string &topic, const char *type, const char *md5,
                                         const char *definition, bool has_header)
{
    for (const boost::shared_ptr<Publication> &each : g_node.publications)
    {
        if (each->topic_ == topic)
        {
            return each;
        }
    }
    const Registration             place = enroll_topic(Kind::publisher, topic, type, md5, definition);
    boost::shared_ptr<Publication> made  = boost::make_shared<Publication>(topic, type, md5, has_header);
    made->msg_id_                        = place.msg_id;
    made->raw_                           = place.raw;
    if (send_from_now_on != nullptr)
    {
        send_from_now_on(place.msg_id);
    }
    if (g_node.has_master && !place.refused && g_node.knows_subscribers)
    {
        know_pipes(place.msg_id, place.pipes);
    }
    g_node.publications.push_back(made);
    return made;
}

bool Publication::is_wanted(bool latch) const
{
    return msg_id_ != 0 && (latch || !g_node.knows_subscribers || pipes_on(msg_id_) > 0);
}

std::uint8_t *Publication::begin(std::size_t size, bool latch)
{
    size_   = size;
    buffer_ = nullptr;
    if (is_long(*this, latch, size))
    {
        need_part(reinterpret_cast<const void *>(begin_long), topic_);
        return begin_long(size);
    }
    CFE_SB_Buffer_t *buffer = begin_packet(msg_id_, kTelemetryHeader + size);
    buffer_                 = buffer;
    return buffer != nullptr ? bytes_of(buffer) + kTelemetryHeader : nullptr;
}

void Publication::write_number(std::uint8_t *at, std::size_t size) const
{
    for (std::size_t byte = 0; has_header_ && size >= 4 && byte < 4; ++byte)
    {
        at[byte] = static_cast<std::uint8_t>(seq_ >> (8 * byte));
    }
}

void Publication::send(Advertised &by)
{
    const auto    buffer = static_cast<CFE_SB_Buffer_t *>(buffer_);
    std::uint8_t *at     = buffer != nullptr ? bytes_of(buffer) + kTelemetryHeader : long_message();
    write_number(at, size_);
    ++seq_;
    buffer_ = nullptr;
    if (buffer != nullptr)
    {
        send_packet(buffer);
    }
    else
    {
        send_long(*this, by, size_);
    }
}

// -- subscribers -------------------------------------------------------------------------------------------------------

void give_to_subscriptions(std::uint16_t msg_id, const std::uint8_t *packet, std::size_t size, int number)
{
    for (std::size_t i = 0; i < g_node.subscriptions.size(); ++i)
    {
        const boost::shared_ptr<Subscription> &each = g_node.subscriptions[i];
        if (each->msg_id_ != msg_id || !each->alive_ || (number != kAll && number != each->number_))
        {
            continue;
        }
        const std::uint32_t bad  = each->bad_;
        bool                more = false;
        if (each->raw_)
        {
            need_part(reinterpret_cast<const void *>(receive_raw), each->topic_);
            more = receive_raw(*each, packet, size);
        }
        else if (size >= kTelemetryHeader)
        {
            more = each->receive(packet + kTelemetryHeader, size - kTelemetryHeader);
        }
        if (each->bad_ != bad && bad == 0)
        {
            CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR,
                              "%s: refused %lu bytes on %s: no message of its type, or one beyond its capacities; told once",
                              g_node.name.c_str(), as<unsigned long>(size), each->topic_.c_str());
        }
        if (more)
        {
            each->callbacks_->addCallback(each, reinterpret_cast<std::uintptr_t>(each.get()));
        }
    }
}

std::uint32_t queue_size(std::uint32_t asked)
{
    const std::uint32_t most = g_node.description->longest_queue;
    return asked == 0 ? most : std::min(asked, most);
}

void subscribe(const boost::shared_ptr<Subscription> &subscription, const char *type, const char *md5,
               const char *definition)
{
    const Registration place = enroll_topic(Kind::subscriber, subscription->topic_, type, md5, definition);
    if (place.refused)
    {
        g_node.subscriptions.push_back(subscription); // which hears nothing, as in ROS
        return;
    }
    bool known            = false;
    subscription->msg_id_ = place.msg_id;
    subscription->raw_    = place.raw;
    for (const boost::shared_ptr<Subscription> &each : g_node.subscriptions)
    {
        known = known || each->msg_id_ == place.msg_id;
    }
    subscription->callbacks_->expect(subscription->queue_);
    if (set_aside != nullptr)
    {
        set_aside(*subscription);
    }
    g_node.subscriptions.push_back(subscription);
    if (!known && !listen(place.msg_id))
    {
        refuse("the Software Bus has no room for the subscription", subscription->topic_.c_str());
    }
    if (known && another_subscription != nullptr)
    {
        another_subscription(subscription);
    }
    if (place.latched)
    {
        ask_for_latched(subscription->topic_, subscription->number_);
    }
}

void unsubscribe(const boost::shared_ptr<Subscription> &subscription)
{
    subscription->alive_ = false;
    auto &all            = g_node.subscriptions;
    all.erase(std::remove(all.begin(), all.end(), subscription), all.end());
    if (g_node.ended)
    {
        return;
    }
    subscription->callbacks_->removeByID(reinterpret_cast<std::uintptr_t>(subscription.get()));
    if (subscription->msg_id_ == 0)
    {
        return; // it was refused
    }
    subscription->callbacks_->expect_no_more(subscription->queue_);
    for (const boost::shared_ptr<Subscription> &each : all)
    {
        if (each->msg_id_ == subscription->msg_id_)
        {
            return;
        }
    }
    CFE_SB_Unsubscribe(CFE_SB_ValueToMsgId(subscription->msg_id_), g_node.pipe);
    if (listen_no_more != nullptr)
    {
        listen_no_more(subscription->msg_id_);
    }
    withdraw_topic(Kind::subscriber, subscription->topic_);
}

} // namespace roscfe

namespace ros
{

Publisher::Publisher(const boost::shared_ptr<roscfe::Advertised> &advertised)
    : handle_(boost::make_shared<Handle>(advertised))
{
}

Publisher::Handle::Handle(const boost::shared_ptr<roscfe::Advertised> &of)
    : advertised(of), topic(of->publication_->topic_)
{
}

void Publisher::Handle::release()
{
    if (!advertised)
    {
        return;
    }
    const boost::shared_ptr<roscfe::Advertised> was = advertised;
    advertised.reset();
    was->end();
    auto &others = was->publication_->advertised_;
    others.erase(std::remove(others.begin(), others.end(), was), others.end());
    if (others.empty())
    {
        auto &all = roscfe::g_node.publications;
        all.erase(std::remove(all.begin(), all.end(), was->publication_), all.end());
        if (!roscfe::g_node.ended)
        {
            roscfe::withdraw_topic(roscfe::Kind::publisher, was->publication_->topic_);
        }
    }
}

Publisher NodeHandle::advertise_as(AdvertiseOptions &options)
{
    const std::string topic = resolveName(options.topic);
    if (roscfe::g_node.is_shut)
    {
        return Publisher();
    }
    for (const auto &each : roscfe::g_node.publications)
    {
        if (each->topic_ == topic && each->md5_ != options.md5sum)
        {
            if (roscfe::log_other_type != nullptr)
            {
                roscfe::log_other_type(*each, options);
            }
            else
            {
                CFE_EVS_SendEvent(roscfe::kBusEid, CFE_EVS_EventType_ERROR, "%s: %s is advertised with another type",
                                  roscfe::g_node.name.c_str(), topic.c_str());
            }
            return Publisher();
        }
    }
    CallbackQueueInterface *queue = options.callback_queue != nullptr ? options.callback_queue : getCallbackQueue();
    auto publication = roscfe::advertise(topic, options.datatype.c_str(), options.md5sum.c_str(),
                                         options.message_definition.c_str(), options.has_header);
    if (roscfe::is_long(*publication, options.latch, options.most_bytes))
    {
        roscfe::need_part(reinterpret_cast<const void *>(roscfe::begin_long), topic);
        roscfe::reserve_long(options.most_bytes);
    }
    const auto advertised = roscfe::make_advertised != nullptr
                                ? roscfe::make_advertised(publication, options, queue)
                                : boost::make_shared<roscfe::Advertised>(publication);
    publication->advertised_.push_back(advertised);
    advertised->begin();
    return Publisher(advertised);
}

Subscriber::Subscriber(const boost::shared_ptr<roscfe::Subscription> &subscription)
    : handle_(boost::make_shared<Handle>(subscription))
{
}

Subscriber::Handle::Handle(const boost::shared_ptr<roscfe::Subscription> &of) : subscription(of), topic(of->topic_) {}

void Subscriber::Handle::release()
{
    if (subscription)
    {
        const boost::shared_ptr<roscfe::Subscription> was = subscription;
        subscription.reset();
        roscfe::unsubscribe(was);
    }
}

Subscriber NodeHandle::subscribe(SubscribeOptions &options)
{
    if (roscfe::g_node.is_shut)
    {
        return Subscriber();
    }
    CallbackQueueInterface *queue = options.callback_queue != nullptr ? options.callback_queue : getCallbackQueue();
    auto subscription             = options.make(options, resolveName(options.topic), queue);
    roscfe::subscribe(subscription, options.type, options.md5sum.c_str(), options.definition);
    return Subscriber(subscription);
}

} // namespace ros
