// The queue of callbacks, and the spinners that empty it.
#include <algorithm>

#include "core.h"
#include "ros/init.h"
#include "ros/spinner.h"
#include "roscfe/heap.h"

namespace ros
{

CallbackQueue *getGlobalCallbackQueue()
{
    return &roscfe::g_node.queue;
}

void CallbackQueue::grow(std::size_t capacity)
{
    std::vector<Entry> larger(capacity);
    for (std::size_t i = 0; i < count_; ++i)
    {
        larger[i] = ring_[(head_ + i) % ring_.size()];
    }
    ring_.swap(larger);
    head_ = 0;
}

void CallbackQueue::expect(std::size_t count)
{
    room_ += count;
    if (ring_.size() < room_)
    {
        grow(std::max(room_, 2 * ring_.size()));
    }
}

void CallbackQueue::append(const CallbackInterfacePtr &callback, std::uint64_t owner_id)
{
    if (count_ == ring_.size())
    {
        grow(std::max<std::size_t>(8, 2 * ring_.size())); // callbacks of the node's own
    }
    Entry &entry   = at(count_);
    entry.callback = callback;
    entry.owner_id = owner_id;
    ++count_;
}

void CallbackQueue::addCallback(const CallbackInterfacePtr &callback, std::uint64_t owner_id)
{
    if (enabled_)
    {
        append(callback, owner_id);
    }
}

void CallbackQueue::removeByID(std::uint64_t owner_id)
{
    std::size_t kept = 0, kept_of_batch = 0;
    for (std::size_t i = 0; i < count_; ++i)
    {
        if (at(i).owner_id == owner_id)
        {
            at(i).callback.reset();
            continue;
        }
        kept_of_batch += i < batch_ ? 1 : 0;
        if (kept++ != i)
        {
            std::swap(at(kept - 1), at(i));
        }
    }
    count_ = kept;
    batch_ = kept_of_batch;
}

bool CallbackQueue::waitForCallback(WallDuration timeout)
{
    const std::int64_t until = roscfe::now_ns() + timeout.toNSec();
    std::int64_t       next  = 0; // at first what is there
    do
    {
        roscfe::pump(next);
        if (roscfe::run_async != nullptr)
        {
            roscfe::run_async();
        }
        next = until;
    } while (count_ == batch_ && !roscfe::g_node.shutting_down && roscfe::now_ns() < until);
    return count_ > batch_ && enabled_;
}

// Call the first one of the batch.
CallbackQueue::CallOneResult CallbackQueue::callFirst()
{
    const CallbackInterfacePtr callback = at(0).callback;
    const std::uint64_t        owner_id = at(0).owner_id;
    at(0).callback.reset();
    head_ = (head_ + 1) % ring_.size();
    --count_;
    --batch_;
    if (callback->call() == CallbackInterface::TryAgain)
    {
        append(callback, owner_id);
        return TryAgain;
    }
    return Called;
}

void CallbackQueue::callAvailable(WallDuration timeout)
{
    if (!enabled_ || !waitForCallback(timeout))
    {
        return;
    }
    // Those that are there now; what callbacks add waits for the next time. In a callback, those that the callback's own
    // caller has not called yet are among them.
    batch_ = count_;
    calling_ += batch_;
    std::size_t called = 0;
    for (; batch_ > 0; ++called)
    {
        callFirst();
    }
    calling_ -= called;
}

namespace
{

// The node has begun: what its arena has given until now is all that a node of the profile strict gets.
void begin_to_spin()
{
    const bool is_first = !roscfe::heap::is_sealed();
    roscfe::heap::seal();
    if (is_first && roscfe::heap::capacity() > 0)
    {
        CFE_EVS_SendEvent(roscfe::kMemoryEid, CFE_EVS_EventType_INFORMATION, "%s: %lu of %lu bytes of the arena are used",
                          roscfe::g_node.name.c_str(), roscfe::as<unsigned long>(roscfe::heap::used()),
                          roscfe::as<unsigned long>(roscfe::heap::capacity()));
    }
}

} // namespace

void spinOnce()
{
    begin_to_spin();
    ok();
    roscfe::g_node.queue.callAvailable();
}

void spin()
{
    SingleThreadedSpinner spinner;
    spinner.spin();
}

void SingleThreadedSpinner::spin_now(CallbackQueue *queue)
{
    begin_to_spin();
    CallbackQueue &    of = queue != nullptr ? *queue : roscfe::g_node.queue;
    const WallDuration look(0, 500000000); // how often ES is asked whether the application is to end
    while (ok())
    {
        of.callAvailable(look);
    }
}

} // namespace ros
