// Publishers and subscribers: what a node makes of them, and their life.
#include <algorithm>
#include <cstring>

#include "internal.h"
#include "ros/advertise_options.h"
#include "ros/console.h"
#include "ros/node_handle.h"
#include "ros/single_subscriber_publisher.h"
#include "ros/this_node.h"

// Where messages go that are not sent, since the topic has no subscriber, while a bag or another watch looks on. cfepy has
// these functions in such runs alone; elsewhere they are not there.
extern "C" {
__attribute__((weak, visibility("default"))) void *cfepy_unsent_room(std::size_t size);
__attribute__((weak, visibility("default"))) void  cfepy_unsent(std::uint16_t msg_id, void *at, std::size_t size);
__attribute__((weak, visibility("default"))) void  cfepy_latches(std::uint16_t msg_id);
}

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
    const Registration place = enroll(Kind::publisher, topic, type, md5, definition);
    boost::shared_ptr<Publication> made  = boost::make_shared<Publication>(topic, type, md5, has_header);
    made->msg_id_                        = place.msg_id;
    made->raw_                           = place.raw;
    send_from_now_on(place.msg_id);
    if (g_node.has_master && !place.refused && g_node.knows_subscribers)
    {
        know_pipes(place.msg_id, place.pipes);
    }
    g_node.publications.push_back(made);
    return made;
}

void Publication::set_aside(bool latch, std::size_t most_bytes)
{
    if (latch || raw_ || most_bytes > kRoom)
    {
        g_long_message.reserve(most_bytes);
    }
}

bool Publication::is_wanted(bool latch) const
{
    return msg_id_ != 0 && (latch || !g_node.knows_subscribers || pipes_on(msg_id_) > 0);
}

std::uint32_t Publication::subscribers() const
{
    return g_node.knows_subscribers || msg_id_ == 0 ? pipes_on(msg_id_) : 1;
}

std::uint8_t *Publication::begin(std::size_t size, bool latch)
{
    size_   = size;
    buffer_ = nullptr;
    if (latch || raw_ || size > kRoom)
    {
        g_long_message.resize(size);
        return g_long_message.data();
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
    std::uint8_t *at = buffer_ != nullptr ? bytes_of(static_cast<CFE_SB_Buffer_t *>(buffer_)) + kTelemetryHeader
                                          : g_long_message.data();
    write_number(at, size_);
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
    if (by.latch_)
    {
        by.keep(at, size_);
    }
    if (!g_node.knows_subscribers || pipes_on(msg_id_) > 0)
    {
        send_bytes(msg_id_, nullptr, 0, at, size_);
    }
    else if (is_watched())
    {
        std::uint8_t *shown = begin_unsent(size_);
        if (shown != nullptr)
        {
            std::memcpy(shown, at, size_);
            cfepy_unsent(msg_id_, shown, size_);
        }
    }
}

bool Publication::is_watched() const
{
    return cfepy_unsent_room != nullptr && msg_id_ != 0;
}

std::uint8_t *Publication::begin_unsent(std::size_t size) const
{
    return static_cast<std::uint8_t *>(cfepy_unsent_room(size));
}

void Publication::show_unsent(std::uint8_t *at, std::size_t size) const
{
    write_number(at, size);
    cfepy_unsent(msg_id_, at, size);
}

// -- what publishers ask for -------------------------------------------------------------------------------------------

namespace
{
constexpr std::size_t kPeersAtOnce = 16; // that wait for a callback, before memory is needed for more
} // namespace

Advertised::Advertised(const boost::shared_ptr<Publication> &publication, const ros::AdvertiseOptions &options,
                       ros::CallbackQueueInterface *callbacks)
    : publication_(publication), latch_(options.latch), connect_(options.connect_cb),
      disconnect_(options.disconnect_cb), callbacks_(callbacks), tracked_(options.tracked_object),
      has_tracked_(options.tracked_object != nullptr)
{
    if (latch_)
    {
        latched_.reserve(options.most_bytes);
    }
    if (connect_ || disconnect_)
    {
        waiting_.reserve(kPeersAtOnce);
        callbacks_->expect(kPeersAtOnce);
    }
}

void Advertised::keep(const std::uint8_t *bytes, std::size_t size)
{
    latched_.assign(bytes, bytes + size);
    has_latched_ = true;
}

void Advertised::tell(std::uint32_t pipe, bool came)
{
    if (is_over_ || !(came ? connect_ : disconnect_))
    {
        return;
    }
#if defined(ROSCFE_PROFILE_STRICT)
    if (waiting_.size() == waiting_.capacity())
    {
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: more than %lu subscribers of %s wait for a callback",
                          g_node.name.c_str(), static_cast<unsigned long>(waiting_.size()), publication_->topic_.c_str());
        return;
    }
#endif
    waiting_.push_back({pipe, came});
    callbacks_->addCallback(shared_from_this(), reinterpret_cast<std::uintptr_t>(this));
}

void Advertised::end()
{
    is_over_ = true;
    waiting_.clear();
    if (!g_node.ended && (connect_ || disconnect_))
    {
        callbacks_->removeByID(reinterpret_cast<std::uintptr_t>(this));
    }
}

ros::CallbackInterface::CallResult Advertised::call()
{
    if (waiting_.empty())
    {
        return Invalid;
    }
    const Peer peer = waiting_.front();
    waiting_.erase(waiting_.begin());
    const ros::VoidConstPtr held = tracked_.lock();
    if (is_over_ || (has_tracked_ && !held))
    {
        return Invalid;
    }
    char                  name[OS_MAX_API_NAME] = "";
    const CFE_SB_PipeId_t pipe                  = CFE_SB_PIPEID_C(CFE_ResourceId_FromInteger(peer.pipe));
    if (peer.came && has_name(pipe) && CFE_SB_GetPipeName(name, sizeof name, pipe) != CFE_SUCCESS)
    {
        return Invalid; // gone already
    }
    const ros::SubscriberStatusCallback &call = peer.came ? connect_ : disconnect_;
    call(ros::SingleSubscriberPublisher(*publication_, peer.pipe, name));
    return Success;
}

namespace
{
// Calls a function with all that publishers of the node have asked for a topic.
template <class F>
void with_all_of(std::uint16_t msg_id, F function)
{
    for (const boost::shared_ptr<Publication> &each : g_node.publications)
    {
        for (std::size_t i = 0; each->msg_id_ == msg_id && i < each->advertised_.size(); ++i)
        {
            function(*each->advertised_[i]);
        }
    }
}

std::uint32_t number_of(CFE_SB_PipeId_t pipe)
{
    return static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe));
}

void repeat(Advertised &by, CFE_SB_PipeId_t pipe, std::uint8_t number)
{
    if (by.has_latched_)
    {
        send_to(*by.publication_, number_of(pipe), by.latched_.data(), by.latched_.size(), number);
    }
}
} // namespace

// A pipe that hears the topic already has one more subscription.
void publication_has_another(std::uint16_t msg_id, CFE_SB_PipeId_t pipe, std::uint8_t number)
{
    with_all_of(msg_id, [&](Advertised &each) { repeat(each, pipe, number); });
}

void publication_lost_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    with_all_of(msg_id, [&](Advertised &each) { each.tell(number_of(pipe), false); });
}

// As in roscpp, what was latched is on its way before a callback is called.
void publication_has_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    with_all_of(msg_id, [&](Advertised &each) {
        repeat(each, pipe, 0);
        each.tell(number_of(pipe), true);
    });
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
    with_all_of(subscription->msg_id_, [&](Advertised &each) {
        if (each.has_latched_ && subscription->receive(each.latched_.data(), each.latched_.size()))
        {
            subscription->callbacks_->addCallback(subscription, reinterpret_cast<std::uintptr_t>(subscription.get()));
        }
    });
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
            roscfe::withdraw_name(roscfe::Kind::publisher, was->publication_->topic_);
        }
    }
}

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
    return handle_->advertised->publication_->subscribers();
}

bool Publisher::isLatched() const
{
    return *this && handle_->advertised->latch_;
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
    if (roscfe::g_node.is_shut)
    {
        return Publisher();
    }
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
    CallbackQueueInterface *queue = options.callback_queue != nullptr ? options.callback_queue : getCallbackQueue();
    auto publication = roscfe::advertise(topic, options.datatype.c_str(), options.md5sum.c_str(),
                                         options.message_definition.c_str(), options.has_header);
    publication->set_aside(options.latch, options.most_bytes);
    const auto advertised = boost::make_shared<roscfe::Advertised>(publication, options, queue);
    publication->advertised_.push_back(advertised);
    if (options.latch && cfepy_latches != nullptr)
    {
        cfepy_latches(publication->msg_id_);
    }
    if (options.connect_cb) // roscpp tells of subscribers that are there a little later
    {
        for (const CFE_SB_PipeId_t pipe : roscfe::those_on(publication->msg_id_))
        {
            advertised->tell(roscfe::number_of(pipe), true);
        }
    }
    return Publisher(advertised);
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
