// Publishers and subscribers: what a node makes of them, and their life.
#include <algorithm>
#include <cstring>

#include "internal.h"
#include "ros/console.h"
#include "ros/node_handle.h"
#include "ros/single_subscriber_publisher.h"
#include "ros/this_node.h"

namespace roscfe
{

namespace
{
// A long message is put together here before it is cut into packets; a short one is written onto the bus itself.
std::vector<std::uint8_t> g_long_message;
constexpr std::size_t     kRoom = CFE_MISSION_SB_MAX_SB_MSG_SIZE - kTelemetryHeader;
} // namespace

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
    const Registration             place = enroll(Kind::publisher, topic, type, md5, definition);
    boost::shared_ptr<Publication> made  = boost::make_shared<Publication>(topic, type, md5, has_header);
    made->msg_id_                        = place.msg_id;
    made->raw_                           = place.raw;
    if (g_node.has_master && !place.refused && g_node.knows_subscribers)
    {
        know_pipes(place.msg_id, place.pipes);
    }
    g_node.publications.push_back(made);
    return made;
}

void Publication::set_aside(std::size_t most_bytes)
{
    if (latch_)
    {
        latched_.reserve(most_bytes);
    }
    if (latch_ || raw_ || most_bytes > kRoom)
    {
        g_long_message.reserve(most_bytes);
    }
}

bool Publication::is_wanted() const
{
    return msg_id_ != 0 && (latch_ || !g_node.knows_subscribers || pipes_on(msg_id_) > 0);
}

std::uint32_t Publication::subscribers() const
{
    return g_node.knows_subscribers || msg_id_ == 0 ? pipes_on(msg_id_) : 1;
}

std::uint8_t *Publication::begin(std::size_t size)
{
    size_   = size;
    buffer_ = nullptr;
    if (latch_ || raw_ || size > kRoom)
    {
        g_long_message.resize(size);
        return g_long_message.data();
    }
    CFE_SB_Buffer_t *buffer = begin_packet(msg_id_, kTelemetryHeader + size);
    buffer_                 = buffer;
    return buffer != nullptr ? bytes_of(buffer) + kTelemetryHeader : nullptr;
}

void Publication::send()
{
    std::uint8_t *at = buffer_ != nullptr ? bytes_of(static_cast<CFE_SB_Buffer_t *>(buffer_)) + kTelemetryHeader
                                          : g_long_message.data();
    if (has_header_ && size_ >= 4)
    {
        for (int byte = 0; byte < 4; ++byte)
        {
            at[byte] = static_cast<std::uint8_t>(seq_ >> (8 * byte));
        }
    }
    ++seq_;
    if (buffer_ != nullptr)
    {
        send_packet(static_cast<CFE_SB_Buffer_t *>(buffer_));
        buffer_ = nullptr;
        return;
    }
    if (raw_)
    {
        // std_msgs/UInt8MultiArray whose data are a whole packet, header included; it goes out as it is.
        const std::size_t lead = 12; // no dimensions, data_offset, length of the data
        if (size_ > lead + 6)
        {
            CFE_SB_Buffer_t *buffer = begin_packet(msg_id_, size_ - lead);
            if (buffer != nullptr)
            {
                std::memcpy(bytes_of(buffer), at + lead, size_ - lead);
                send_packet(buffer);
            }
        }
        return;
    }
    if (latch_)
    {
        latched_.assign(at, at + size_);
    }
    if (!g_node.knows_subscribers || pipes_on(msg_id_) > 0)
    {
        send_bytes(msg_id_, nullptr, 0, at, size_);
    }
}

namespace
{
void call_all(const std::vector<ros::SubscriberStatusCallback> &calls, const ros::SingleSubscriberPublisher &only)
{
    for (const ros::SubscriberStatusCallback &call : calls)
    {
        call(only);
    }
}
} // namespace

namespace
{
// A subscriber that was there before a publisher that wants to hear of it: roscpp connects both a little later.
class EarlierSubscriber : public ros::CallbackInterface
{
  public:
    EarlierSubscriber(const boost::shared_ptr<Publication> &publication, const ros::AdvertiseOptions &options,
                      CFE_SB_PipeId_t pipe)
        : publication_(publication), call_(options.connect_cb), tracked_(options.tracked_object),
          is_tracked_(options.tracked_object != nullptr), pipe_(pipe)
    {
    }

    CallResult call() override
    {
        const boost::shared_ptr<Publication> publication = publication_.lock();
        const ros::VoidConstPtr              held        = tracked_.lock();
        char                                 name[OS_MAX_API_NAME];
        if (!publication || publication->users_ == 0 || (is_tracked_ && !held))
        {
            return Invalid;
        }
        if (CFE_RESOURCEID_TO_ULONG(pipe_) == 0)
        {
            name[0] = '\0';
        }
        else if (CFE_SB_GetPipeName(name, sizeof name, pipe_) != CFE_SUCCESS)
        {
            return Invalid; // gone already
        }
        const auto number = static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe_));
        call_(ros::SingleSubscriberPublisher(*publication, number, name));
        return Success;
    }

  private:
    boost::weak_ptr<Publication>  publication_;
    ros::SubscriberStatusCallback call_;
    ros::VoidConstWPtr            tracked_;
    bool                          is_tracked_;
    CFE_SB_PipeId_t               pipe_;
};

void tell_of_those_on(const boost::shared_ptr<Publication> &publication, const ros::AdvertiseOptions &options)
{
    ros::CallbackQueueInterface &queue = options.callback_queue != nullptr ? *options.callback_queue : g_node.queue;
    for (const CFE_SB_PipeId_t pipe : those_on(publication->msg_id_))
    {
        queue.expect(1);
        queue.addCallback(boost::make_shared<EarlierSubscriber>(publication, options, pipe), 0);
    }
}
} // namespace

// A pipe that hears the topic already has one more subscription.
void publication_has_another(std::uint16_t msg_id, CFE_SB_PipeId_t pipe, std::uint8_t number)
{
    for (const boost::shared_ptr<Publication> &each : g_node.publications)
    {
        if (each->msg_id_ == msg_id && each->users_ > 0 && each->latch_ && !each->latched_.empty())
        {
            send_to(*each, static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe)), each->latched_.data(),
                    each->latched_.size(), number);
        }
    }
}

void publication_lost_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    for (const boost::shared_ptr<Publication> &each : g_node.publications)
    {
        if (each->msg_id_ == msg_id && each->users_ > 0)
        {
            const auto number = static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe));
            call_all(each->on_disconnect_, ros::SingleSubscriberPublisher(*each, number, ""));
        }
    }
}

void publication_has_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    for (const boost::shared_ptr<Publication> &each : g_node.publications)
    {
        if (each->msg_id_ != msg_id || each->users_ == 0)
        {
            continue;
        }
        const auto number = static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe));
        char       name[OS_MAX_API_NAME];
        if (CFE_SB_GetPipeName(name, sizeof name, pipe) != CFE_SUCCESS)
        {
            continue; // gone already
        }
        const ros::SingleSubscriberPublisher only(*each, number, name);
        call_all(each->on_connect_, only);
        if (each->latch_ && !each->latched_.empty())
        {
            send_to(*each, number, each->latched_.data(), each->latched_.size());
        }
    }
}

std::uint32_t queue_size(std::uint32_t asked)
{
    const std::uint32_t most = g_node.description->longest_queue;
    return asked == 0 ? most : std::min(asked, most);
}

namespace
{
constexpr std::uint8_t kMostNumbers = 127;
std::uint8_t           g_numbers    = 0; // given to subscriptions that are not the first ones

// The bus tells publishers of a node's first subscription to a topic only; its own latched topics it sees itself.
void give_latched(const boost::shared_ptr<Subscription> &subscription)
{
    for (const boost::shared_ptr<Publication> &each : g_node.publications)
    {
        if (each->msg_id_ == subscription->msg_id_ && each->latch_ && !each->latched_.empty() &&
            subscription->receive(each->latched_.data(), each->latched_.size()))
        {
            subscription->callbacks_->addCallback(subscription, reinterpret_cast<std::uintptr_t>(subscription.get()));
        }
    }
}
} // namespace

void subscribe(const boost::shared_ptr<Subscription> &subscription, const char *type, const char *md5,
               const char *definition)
{
    const Registration place = enroll(Kind::subscriber, subscription->topic_, type, md5, definition);
    if (place.refused)
    {
        g_node.subscriptions.push_back(subscription); // which hears nothing, as in ROS
        return;
    }
    bool known               = false;
    subscription->msg_id_    = place.msg_id;
    subscription->raw_       = place.raw;
    for (const boost::shared_ptr<Subscription> &each : g_node.subscriptions)
    {
        known = known || each->msg_id_ == place.msg_id;
    }
    subscription->callbacks_->expect(subscription->queue_);
    set_aside(*subscription);
    g_node.subscriptions.push_back(subscription);
    if (!known && !listen(place.msg_id))
    {
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: no subscription of %s", g_node.name.c_str(),
                          subscription->topic_.c_str());
    }
    if (known)
    {
        g_numbers             = static_cast<std::uint8_t>(g_numbers % kMostNumbers + 1);
        subscription->number_ = g_numbers;
        give_latched(subscription);
        ask_for_repetition(place.msg_id, subscription->number_);
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
    for (const boost::shared_ptr<Subscription> &each : all)
    {
        if (each->msg_id_ == subscription->msg_id_)
        {
            return;
        }
    }
    if (subscription->msg_id_ == 0)
    {
        return; // it was refused
    }
    listen_no_more(subscription->msg_id_);
    withdraw_name(Kind::subscriber, subscription->topic_);
}

} // namespace roscfe

namespace ros
{

// -- ros::Publisher ----------------------------------------------------------------------------------------------------

Publisher::Publisher(const boost::shared_ptr<roscfe::Publication> &publication)
    : handle_(boost::make_shared<Handle>(publication))
{
}

Publisher::Handle::Handle(const boost::shared_ptr<roscfe::Publication> &of) : publication(of), topic(of->topic_)
{
    ++publication->users_;
}

void Publisher::Handle::release()
{
    if (!publication)
    {
        return;
    }
    const boost::shared_ptr<roscfe::Publication> was = publication;
    publication.reset();
    if (--was->users_ == 0)
    {
        auto &all = roscfe::g_node.publications;
        all.erase(std::remove(all.begin(), all.end(), was), all.end());
        if (!roscfe::g_node.ended)
        {
            roscfe::withdraw_name(roscfe::Kind::publisher, was->topic_);
        }
    }
}

void Publisher::shutdown()
{
    if (handle_)
    {
        handle_->release();
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
    return handle_->publication->subscribers();
}

bool Publisher::isLatched() const
{
    return *this && handle_->publication->latch_;
}

// -- ros::Subscriber ---------------------------------------------------------------------------------------------------

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

// -- of a node handle --------------------------------------------------------------------------------------------------

Publisher NodeHandle::advertise(AdvertiseOptions &options)
{
    const std::string topic = resolveName(options.topic);
    for (const auto &each : roscfe::g_node.publications)
    {
        if (each->topic_ == topic && each->md5_ != options.md5sum)
        {
            ROS_ERROR("Tried to advertise on topic [%s] with md5sum [%s] and datatype [%s], but the topic is already "
                      "advertised as md5sum [%s] and datatype [%s]",
                      topic.c_str(), options.md5sum.c_str(), options.datatype.c_str(), each->md5_.c_str(),
                      each->type_.c_str());
            return Publisher();
        }
    }
    auto publication = roscfe::advertise(topic, options.datatype.c_str(), options.md5sum.c_str(),
                                         options.message_definition.c_str(), options.has_header);
    publication->latch_ = publication->latch_ || options.latch;
    publication->set_aside(options.most_bytes);
    if (options.connect_cb)
    {
        publication->on_connect_.push_back(options.connect_cb);
        roscfe::tell_of_those_on(publication, options);
    }
    if (options.disconnect_cb)
    {
        publication->on_disconnect_.push_back(options.disconnect_cb);
    }
    return Publisher(publication);
}

Subscriber NodeHandle::subscribe(SubscribeOptions &options)
{
    CallbackQueueInterface *queue = options.callback_queue != nullptr ? options.callback_queue : getCallbackQueue();
    auto subscription             = options.make(options, resolveName(options.topic), queue);
    roscfe::subscribe(subscription, options.type, options.md5sum.c_str(), options.definition);
    return Subscriber(subscription);
}

namespace this_node
{

void getAdvertisedTopics(V_string &topics)
{
    topics.clear();
    for (const auto &each : roscfe::g_node.publications)
    {
        topics.push_back(each->topic_);
    }
}

void getSubscribedTopics(V_string &topics)
{
    topics.clear();
    for (const auto &each : roscfe::g_node.subscriptions)
    {
        topics.push_back(each->topic_);
    }
}

} // namespace this_node

} // namespace ros
