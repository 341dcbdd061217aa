// What publishers ask for beside plain messages: one that is kept for subscribers that come later, and callbacks that are
// told of subscribers.
#include "internal.h"
#include "ros/advertise_options.h"
#include "ros/single_subscriber_publisher.h"
#include "roscfe/parts.h"

// cfepy has this function in runs alone that somebody looks at.
extern "C" __attribute__((weak, visibility("default"))) void cfepy_latches(std::uint16_t msg_id);

namespace roscfe
{

namespace parts
{
extern const char latching = 0;
}

namespace
{
constexpr std::size_t  kPeersAtOnce = 16; // that wait for a callback, before memory is needed for more
constexpr std::uint8_t kMostNumbers = 127;
std::uint8_t           g_numbers    = 0; // given to subscriptions that are not the first ones

std::uint32_t number_of(CFE_SB_PipeId_t pipe)
{
    return static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe));
}

class Latching final : public Advertised,
                       public ros::CallbackInterface,
                       public boost::enable_shared_from_this<Latching>
{
  public:
    Latching(const boost::shared_ptr<Publication> &publication, const ros::AdvertiseOptions &options,
             ros::CallbackQueueInterface *callbacks);

    void       begin() override;
    void       tell(std::uint32_t pipe, bool came) override;
    void       end() override;
    void       keep(const std::uint8_t *bytes, std::size_t size) override;
    void       repeat(std::uint32_t pipe, std::uint8_t number) override;
    void       give_kept(const boost::shared_ptr<Subscription> &subscription) override;
    CallResult call() override;

  private:
    struct Peer
    {
        std::uint32_t pipe;
        bool          came;
    };

    bool                          has_latched_ = false;
    std::vector<std::uint8_t>     latched_; // the last message
    ros::SubscriberStatusCallback connect_, disconnect_;
    ros::CallbackQueueInterface * callbacks_;
    ros::VoidConstWPtr            tracked_;
    bool                          has_tracked_;
    bool                          is_over_ = false;
    std::vector<Peer>             waiting_;
};

} // namespace

Latching::Latching(const boost::shared_ptr<Publication> &publication, const ros::AdvertiseOptions &options,
                   ros::CallbackQueueInterface *callbacks)
    : Advertised(publication, options.latch), connect_(options.connect_cb),
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

void Latching::begin()
{
    if (latch_ && cfepy_latches != nullptr)
    {
        cfepy_latches(publication_->msg_id_);
    }
    if (connect_ && those_on != nullptr) // roscpp tells of subscribers that are there a little later
    {
        for (const CFE_SB_PipeId_t pipe : those_on(publication_->msg_id_))
        {
            tell(number_of(pipe), true);
        }
    }
}

void Latching::keep(const std::uint8_t *bytes, std::size_t size)
{
    latched_.assign(bytes, bytes + size);
    has_latched_ = true;
}

void Latching::tell(std::uint32_t pipe, bool came)
{
    if (is_over_ || !(came ? connect_ : disconnect_))
    {
        return;
    }
#if defined(ROSCFE_PROFILE_STRICT)
    if (waiting_.size() == waiting_.capacity())
    {
        CFE_EVS_SendEvent(kBusEid, CFE_EVS_EventType_ERROR, "%s: more than %lu subscribers of %s wait for a callback",
                          g_node.name.c_str(), as<unsigned long>(waiting_.size()), publication_->topic_.c_str());
        return;
    }
#endif
    waiting_.push_back({pipe, came});
    callbacks_->addCallback(shared_from_this(), reinterpret_cast<std::uintptr_t>(this));
}

void Latching::end()
{
    is_over_ = true;
    waiting_.clear();
    if (!g_node.ended && (connect_ || disconnect_))
    {
        callbacks_->removeByID(reinterpret_cast<std::uintptr_t>(this));
        callbacks_->expect_no_more(kPeersAtOnce);
    }
}

ros::CallbackInterface::CallResult Latching::call()
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

void Latching::repeat(std::uint32_t pipe, std::uint8_t number)
{
    if (has_latched_)
    {
        send_to(*publication_, pipe, latched_.data(), latched_.size(), number);
    }
}

void Latching::give_kept(const boost::shared_ptr<Subscription> &subscription)
{
    if (has_latched_ && subscription->receive(latched_.data(), latched_.size()))
    {
        subscription->callbacks_->addCallback(subscription, reinterpret_cast<std::uintptr_t>(subscription.get()));
    }
}

boost::shared_ptr<Advertised> make_advertised(const boost::shared_ptr<Publication> &publication,
                                              const ros::AdvertiseOptions &options, ros::CallbackQueueInterface *callbacks)
{
    return boost::make_shared<Latching>(publication, options, callbacks);
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

} // namespace

// A pipe that hears the topic already has one more subscription.
void publication_has_another(std::uint16_t msg_id, CFE_SB_PipeId_t pipe, std::uint8_t number)
{
    with_all_of(msg_id, [&](Advertised &each) { each.repeat(number_of(pipe), number); });
}

void publication_lost_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    with_all_of(msg_id, [&](Advertised &each) { each.tell(number_of(pipe), false); });
}

// As in roscpp, what was latched is on its way before a callback is called.
void publication_has_subscriber(std::uint16_t msg_id, CFE_SB_PipeId_t pipe)
{
    with_all_of(msg_id, [&](Advertised &each) {
        each.repeat(number_of(pipe), 0);
        each.tell(number_of(pipe), true);
    });
}

// The bus tells publishers of a node's first subscription to a topic only; its own latched topics it sees itself.
void another_subscription(const boost::shared_ptr<Subscription> &subscription)
{
    g_numbers             = static_cast<std::uint8_t>(g_numbers % kMostNumbers + 1);
    subscription->number_ = g_numbers;
    with_all_of(subscription->msg_id_, [&](Advertised &each) { each.give_kept(subscription); });
    if (ask_for_repetition != nullptr)
    {
        ask_for_repetition(subscription->msg_id_, subscription->number_);
    }
}

void send_to(Publication &publication, std::uint32_t pipe, const std::uint8_t *bytes, std::size_t size,
             std::uint8_t number)
{
    address_to(pipe, number);
    send_bytes(publication.msg_id_, nullptr, 0, bytes, size);
    address_to(0, 0);
}

} // namespace roscfe
