// Queues of callbacks, and the spinners that empty them.
#include <algorithm>

#include "internal.h"
#include "ros/init.h"
#include "ros/spinner.h"
#include "roscfe/heap.h"

namespace ros
{

CallbackQueue *getGlobalCallbackQueue()
{
    return &roscfe::g_node.queue;
}

CallbackQueue *getInternalCallbackQueue()
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

// Those that are being called are not among them.
void CallbackQueue::clear()
{
    for (; count_ > batch_; --count_)
    {
        at(count_ - 1).callback.reset();
    }
}

bool CallbackQueue::waitForCallback(WallDuration timeout)
{
    const std::int64_t until = roscfe::now_ns() + timeout.toNSec();
    roscfe::pump(0);
    roscfe::run_async();
    while (count_ == batch_ && !roscfe::g_node.shutting_down && roscfe::now_ns() < until)
    {
        roscfe::pump(until);
        roscfe::run_async();
    }
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

CallbackQueue::CallOneResult CallbackQueue::callOne(WallDuration timeout)
{
    if (!enabled_)
    {
        return Disabled;
    }
    if (!waitForCallback(timeout))
    {
        return enabled_ ? Empty : Disabled;
    }
    std::size_t ready = batch_;
    while (ready < count_ && !at(ready).callback->ready())
    {
        ++ready;
    }
    if (ready == count_)
    {
        return TryAgain;
    }
    for (; ready > batch_; --ready)
    {
        std::swap(at(ready - 1), at(ready));
    }
    // In a callback it is another's turn: the one that was about to be called.
    ++batch_;
    ++calling_;
    const CallOneResult result = callFirst();
    --calling_;
    return result;
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

// -- spinners ----------------------------------------------------------------------------------------------------------

void spinOnce()
{
    roscfe::heap::seal();
    ok();
    roscfe::g_node.queue.callAvailable();
}

void spin()
{
    SingleThreadedSpinner spinner;
    spin(spinner);
}

void spin(Spinner &spinner)
{
    spinner.spin();
}

void SingleThreadedSpinner::spin_now(CallbackQueue *queue)
{
    roscfe::heap::seal();
    CallbackQueue &      of = queue != nullptr ? *queue : roscfe::g_node.queue;
    const ros::WallDuration look(0.5); // how often ES is asked whether the application is to end
    while (ok())
    {
        of.callAvailable(look);
    }
}

AsyncSpinner::AsyncSpinner(std::uint32_t, CallbackQueue *queue) : queue_(queue) {}

void AsyncSpinner::start()
{
    if (!started_)
    {
        started_ = true;
        roscfe::start_async(queue_ != nullptr ? queue_ : &roscfe::g_node.queue);
    }
}

void AsyncSpinner::stop()
{
    if (started_)
    {
        started_ = false;
        roscfe::stop_async(queue_ != nullptr ? queue_ : &roscfe::g_node.queue);
    }
}

} // namespace ros

namespace roscfe
{

namespace
{
std::vector<ros::CallbackQueue *> g_async; // queues whose callbacks run while the node waits
bool                              g_in_async = false;
} // namespace

void start_async(ros::CallbackQueue *queue)
{
    g_async.push_back(queue);
}

void stop_async(ros::CallbackQueue *queue)
{
    const auto found = std::find(g_async.begin(), g_async.end(), queue);
    if (found != g_async.end())
    {
        g_async.erase(found);
    }
}

void run_async()
{
    if (g_in_async)
    {
        return; // a callback that waits: in a thread of a spinner nothing else would run, either
    }
    g_in_async = true;
    for (std::size_t i = 0; i < g_async.size(); ++i)
    {
        g_async[i]->callAvailable();
    }
    g_in_async = false;
}

bool wait_for_news(std::int64_t until_ns)
{
    const bool more = pump(until_ns);
    run_async();
    return more;
}

} // namespace roscfe
