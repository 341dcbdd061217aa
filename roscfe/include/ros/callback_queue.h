// Callbacks that wait for spinOnce, spin or callAvailable, in the order in which they came.
#ifndef ROS_CALLBACK_QUEUE_H
#define ROS_CALLBACK_QUEUE_H

#include <cstddef>
#include <vector>

#include "ros/callback_queue_interface.h"
#include "ros/time.h"

namespace ros
{

class CallbackQueue : public CallbackQueueInterface
{
  public:
    enum CallOneResult
    {
        Called,
        TryAgain,
        Disabled,
        Empty
    };

    explicit CallbackQueue(bool enabled = true) : enabled_(enabled) {}
    CallbackQueue(const CallbackQueue &) = delete;
    CallbackQueue &operator=(const CallbackQueue &) = delete;

    void addCallback(const CallbackInterfacePtr &callback, std::uint64_t owner_id = 0) override;
    void removeByID(std::uint64_t owner_id) override;
    void expect(std::size_t count) override;
    void expect_no_more(std::size_t count) override { room_ -= count; }

    // Call the first one, all that are there, or wait up to a time for the first.
    CallOneResult callOne() { return callOne(WallDuration()); }
    CallOneResult callOne(WallDuration timeout);
    void          callAvailable() { callAvailable(WallDuration()); }
    void          callAvailable(WallDuration timeout);

    // As roscpp counts: a queue is not empty while one of its callbacks runs, nor ever again after a callback has
    // emptied it for the others, or has removed one of those that were about to be called.
    bool empty() const { return count_ == batch_ && calling_ == 0; }
    bool isEmpty() const { return empty(); }
    std::size_t waiting() const { return count_; } // callbacks
    void clear();
    void enable() { enabled_ = true; }
    void disable() { enabled_ = false; }
    bool isEnabled() const { return enabled_; }

  private:
    struct Entry
    {
        CallbackInterfacePtr callback;
        std::uint64_t        owner_id = 0;
    };

    Entry &       at(std::size_t place) { return ring_[(head_ + place) % ring_.size()]; }
    CallOneResult callFirst();
    bool          waitForCallback(WallDuration timeout);
    void          append(const CallbackInterfacePtr &callback, std::uint64_t owner_id);
    void          grow(std::size_t capacity);

    bool               enabled_;
    std::vector<Entry> ring_;
    std::size_t        head_    = 0;
    std::size_t        count_   = 0;
    std::size_t        batch_   = 0; // the first ones: they are being called, and what comes meanwhile waits
    std::size_t        calling_ = 0; // as roscpp counts them
    std::size_t        room_    = 0; // that was asked for
};

// The queue that node handles use that say nothing else.
CallbackQueue *getGlobalCallbackQueue();

} // namespace ros

#endif
