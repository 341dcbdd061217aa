// tf2_ros::MessageFilter: passes messages on when their frame can be transformed at their time.
#ifndef TF2_ROS_MESSAGE_FILTER_H
#define TF2_ROS_MESSAGE_FILTER_H

#include <boost/function.hpp>
#include <boost/shared_ptr.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "message_filters/connection.h"
#include "message_filters/simple_filter.h"
#include "ros/init.h"
#include "ros/message_traits.h"
#include "ros/node_handle.h"
#include "roscfe/slots.h"
#include "roscfe/subscription.h"
#include "tf2/buffer_core.h"

namespace tf2_ros
{

namespace filter_failure_reasons
{
enum FilterFailureReason
{
    Unknown,     // also: the queue was full
    OutTheBack,  // older than what the buffer keeps
    EmptyFrameID // it has no frame
};
}
typedef filter_failure_reasons::FilterFailureReason FilterFailureReason;

class MessageFilterBase
{
  public:
    typedef std::vector<std::string> V_string;

    virtual ~MessageFilterBase() = default;
    virtual void          clear() = 0;
    virtual void          setTargetFrame(const std::string &target_frame) = 0;
    virtual void          setTargetFrames(const V_string &target_frames) = 0;
    virtual void          setTolerance(const ros::Duration &tolerance) = 0;
    virtual void          setQueueSize(std::uint32_t new_queue_size) = 0;
    virtual std::uint32_t getQueueSize() = 0;
};

// Messages that have to wait are copied, so that they do not take the places of those that come after them.
template <class M>
class MessageFilter : public MessageFilterBase,
                      public message_filters::SimpleFilter<M>,
                      private roscfe::frames::Buffer::Watcher
{
  public:
    typedef boost::shared_ptr<M const>                                    MConstPtr;
    typedef ros::MessageEvent<M const>                                    MEvent;
    typedef boost::function<void(const MConstPtr &, FilterFailureReason)> FailureCallback;

    MessageFilter(tf2::BufferCore &bc, const std::string &target_frame, std::uint32_t queue_size,
                  const ros::NodeHandle &nh)
        : MessageFilter(bc, target_frame, queue_size, nh.getCallbackQueue())
    {
    }
    template <class F>
    MessageFilter(F &f, tf2::BufferCore &bc, const std::string &target_frame, std::uint32_t queue_size,
                  const ros::NodeHandle &nh)
        : MessageFilter(bc, target_frame, queue_size, nh.getCallbackQueue())
    {
        connectInput(f);
    }
    template <class F>
    MessageFilter(F &f, tf2::BufferCore &bc, const std::string &target_frame, std::uint32_t queue_size,
                  ros::CallbackQueueInterface *cbqueue)
        : MessageFilter(bc, target_frame, queue_size, cbqueue)
    {
        connectInput(f);
    }
    MessageFilter(tf2::BufferCore &bc, const std::string &target_frame, std::uint32_t queue_size,
                  ros::CallbackQueueInterface *cbqueue)
        : bc_(bc), callbacks_(cbqueue), delivery_(boost::make_shared<Delivery>(this))
    {
        MessageFilter::setQueueSize(queue_size);
        MessageFilter::setTargetFrame(target_frame);
        bc_.frames().watch(*this);
    }
    ~MessageFilter() override
    {
        bc_.frames().watch_no_more(*this);
        input_.disconnect();
        MessageFilter::clear();
        if (callbacks_ != nullptr)
        {
            callbacks_->expect_no_more(2 * room_);
        }
    }
    MessageFilter(const MessageFilter &) = delete;
    MessageFilter &operator=(const MessageFilter &) = delete;

    template <class F>
    void connectInput(F &f)
    {
        input_.disconnect();
        input_ = f.registerCallback(&MessageFilter::incoming, this);
    }

    void setTargetFrame(const std::string &target_frame) override { setTargetFrames(V_string(1, target_frame)); }
    void setTargetFrames(const V_string &target_frames) override
    {
        target_frames_ = target_frames;
        for (std::string &each : target_frames_)
        {
            each = std::string(bare(each));
        }
        make_room();
        requests_.clear();
        for (std::size_t at = 0; at < waiting_.size();)
        {
            const Waiting each  = waiting_[at];
            const Asked   asked = ask(*each.event.getConstMessage(), each.number);
            if (!asked.never && asked.later > 0)
            {
                waiting_[at++].left = asked.later;
                continue;
            }
            forget(each.number);
            waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(at));
            finish(each.event, !asked.never, filter_failure_reasons::Unknown);
        }
    }
    std::string getTargetFramesString() const
    {
        std::string all;
        for (const std::string &each : target_frames_)
        {
            all += each + " ";
        }
        return all;
    }

    // A message is passed on when it can be transformed at its time, and so much later.
    void setTolerance(const ros::Duration &tolerance) override
    {
        tolerance_ = tolerance;
        make_room();
    }

    void setQueueSize(std::uint32_t new_queue_size) override
    {
        if (callbacks_ != nullptr)
        {
            callbacks_->expect_no_more(2 * room_);
        }
        queue_size_ = new_queue_size;
        room_       = roscfe::queue_size(new_queue_size);
        slots_      = boost::make_shared<roscfe::Slots<M>>(room_ + kKept);
        waiting_.reserve(room_);
        make_room();
        done_.reserve(2 * room_);
        if (callbacks_ != nullptr)
        {
            callbacks_->expect(2 * room_);
        }
    }
    std::uint32_t getQueueSize() override { return queue_size_; }

    // Forget the messages that wait.
    void clear() override
    {
        waiting_.clear();
        requests_.clear();
        done_.clear();
        if (callbacks_ != nullptr)
        {
            callbacks_->removeByID(id());
        }
    }

    void add(const MConstPtr &message) { add(MEvent(message, ros::Time::now())); }
    void add(const MEvent &event)
    {
        if (target_frames_.empty())
        {
            return;
        }
        const M &message = *event.getConstMessage();
        if (frame_of(message).empty())
        {
            finish(event, false, filter_failure_reasons::EmptyFrameID);
            return;
        }
        const Asked asked = ask(message, ++number_);
        if (asked.never || asked.later == 0)
        {
            forget(number_);
            finish(event, !asked.never, filter_failure_reasons::OutTheBack);
            return;
        }
        if (!waiting_.empty() && (waiting_.size() >= room_ || !slots_->any()))
        {
            forget(waiting_.front().number);
            finish(waiting_.front().event, false, filter_failure_reasons::Unknown);
            waiting_.erase(waiting_.begin());
        }
        if (!slots_->any()) // the node holds all that there are
        {
            forget(number_);
            finish(event, false, filter_failure_reasons::Unknown);
            return;
        }
        const boost::shared_ptr<M> copy = roscfe::Slots<M>::take(slots_);
        *copy                           = message;
        waiting_.push_back(Waiting{MEvent(copy, event.getReceiptTime()), number_, asked.later});
    }

    message_filters::Connection registerFailureCallback(const FailureCallback &callback)
    {
        failures_.push_back(callback);
        const std::size_t at = failures_.size() - 1;
        return message_filters::Connection([this, at]() { failures_[at] = FailureCallback(); });
    }

  private:
    static constexpr std::uint32_t kKept = 4; // messages that the node may hold beside those that wait

    enum class Prospect
    {
        now,
        later,
        never
    };
    // A message that waits, and how many of its requests have no answer yet.
    struct Waiting
    {
        MEvent        event;
        std::uint32_t number;
        std::uint32_t left;
    };
    // A question to the buffer: can this message be transformed into a target frame, at its time or later?
    struct Request
    {
        std::uint32_t number;
        std::uint32_t target;
        bool          is_later;
    };
    struct Asked
    {
        std::uint32_t later = 0;     // requests whose answer comes later
        bool          never = false; // an answer is no
    };
    struct Done
    {
        MEvent              event;
        bool                good;
        FilterFailureReason reason;
    };
    // What waits in the node's queue of callbacks: once for each message that is done.
    struct Delivery : ros::CallbackInterface
    {
        explicit Delivery(MessageFilter *of) : filter(of) {}
        CallResult call() override
        {
            filter->deliver();
            return Success;
        }
        MessageFilter *filter;
    };

    static std::string_view bare(std::string_view frame)
    {
        return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
    }
    static std::string_view frame_of(const M &message)
    {
        return bare(roscfe::frames::Name(message.header.frame_id).view());
    }
    std::uint64_t id() const { return reinterpret_cast<std::uintptr_t>(this); }

    void incoming(const MEvent &event) { add(event); }

    void make_room()
    {
        requests_.reserve((room_ + 1) * target_frames_.size() * (tolerance_.isZero() ? 1 : 2));
        answered_.reserve(requests_.capacity());
    }

    // Ask for each target frame, and keep the requests whose answer comes later.
    Asked ask(const M &message, std::uint32_t number)
    {
        Asked asked;
        for (std::uint32_t target = 0; target < target_frames_.size() && !asked.never; ++target)
        {
            for (const bool is_later : {false, true})
            {
                const Prospect one = is_later && tolerance_.isZero() ? Prospect::now : look(message, target, is_later);
                asked.never        = asked.never || one == Prospect::never;
                if (one == Prospect::later)
                {
                    requests_.push_back(Request{number, target, is_later});
                    ++asked.later;
                }
            }
        }
        return asked;
    }
    void forget(std::uint32_t number)
    {
        requests_.erase(std::remove_if(requests_.begin(), requests_.end(),
                                       [number](const Request &each) { return each.number == number; }),
                        requests_.end());
    }
    std::size_t place_of(std::uint32_t number) const
    {
        std::size_t at = 0;
        while (at < waiting_.size() && waiting_[at].number != number)
        {
            ++at;
        }
        return at;
    }

    Prospect look(const M &message, std::uint32_t target, bool is_later) const
    {
        const ros::Time time = message.header.stamp + (is_later ? tolerance_ : ros::Duration());
        return look(target_frames_[target], frame_of(message), time);
    }
    bool is_transformable(const M &message) const
    {
        for (std::uint32_t target = 0; target < target_frames_.size(); ++target)
        {
            if (look(message, target, false) != Prospect::now || look(message, target, true) != Prospect::now)
            {
                return false;
            }
        }
        return true;
    }
    Prospect look(std::string_view target, std::string_view source, const ros::Time &time) const
    {
        if (target == source || bc_.canTransform(target, source, time))
        {
            return Prospect::now;
        }
        ros::Time latest;
        bc_._getLatestCommonTime(bc_._lookupFrameNumber(target), bc_._lookupFrameNumber(source), latest, nullptr);
        return !latest.isZero() && time + bc_.getCacheLength() < latest ? Prospect::never : Prospect::later;
    }

    // The order is tf2's: the last request takes the place of one that is answered. An answer holds once it is there, so
    // the message is looked at again when all answers are: what was possible first may be too old now.
    void transforms_changed() override
    {
        std::vector<std::uint32_t> answered;
        answered.swap(answered_);
        for (std::size_t at = 0; at < requests_.size();)
        {
            const Request request = requests_[at];
            const M &     message = *waiting_[place_of(request.number)].event.getConstMessage();
            if (look(message, request.target, request.is_later) == Prospect::later)
            {
                ++at;
                continue;
            }
            answered.push_back(request.number);
            requests_[at] = requests_.back();
            requests_.pop_back();
        }
        for (const std::uint32_t number : answered)
        {
            const std::size_t at = place_of(number);
            if (at == waiting_.size() || --waiting_[at].left > 0)
            {
                continue;
            }
            const MEvent event = waiting_[at].event;
            waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(at));
            finish(event, is_transformable(*event.getConstMessage()), filter_failure_reasons::Unknown);
        }
        answered.clear();
        answered_.swap(answered);
    }

    void finish(const MEvent &event, bool good, FilterFailureReason reason)
    {
        if (callbacks_ == nullptr)
        {
            tell(Done{event, good, reason});
            return;
        }
        if (done_.size() >= 2 * room_) // the node has not spun for long; a callback for each is on its way
        {
            done_.erase(done_.begin());
        }
        else
        {
            callbacks_->addCallback(delivery_, id());
        }
        done_.push_back(Done{event, good, reason});
    }
    void deliver()
    {
        if (!done_.empty())
        {
            const Done first = done_.front();
            done_.erase(done_.begin());
            tell(first);
        }
    }
    void tell(const Done &done)
    {
        if (done.good)
        {
            this->signalMessage(done.event);
            return;
        }
        for (std::size_t at = 0; at < failures_.size(); ++at)
        {
            if (failures_[at])
            {
                failures_[at](done.event.getConstMessage(), done.reason);
            }
        }
    }

    tf2::BufferCore &                   bc_;
    ros::CallbackQueueInterface *       callbacks_;
    boost::shared_ptr<Delivery>         delivery_;
    boost::shared_ptr<roscfe::Slots<M>> slots_;
    V_string                            target_frames_;
    ros::Duration                       tolerance_;
    std::uint32_t                       queue_size_ = 0; // as asked for; 0 is no limit
    std::uint32_t                       room_       = 0;
    std::uint32_t                       number_     = 0; // of the last message
    std::vector<Waiting>                waiting_;
    std::vector<Request>                requests_;
    std::vector<std::uint32_t>          answered_; // its memory is used again
    std::vector<Done>                   done_;
    std::vector<FailureCallback>        failures_;
    message_filters::Connection         input_;
};

} // namespace tf2_ros

#endif
