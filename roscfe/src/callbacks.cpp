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

void CallbackQueue::addCallback(const CallbackInterfacePtr &callback, std::uint64_t owner_id)
{
    if (!enabled_)
    {
        return;
    }
    if (count_ == ring_.size())
    {
        grow(std::max<std::size_t>(8, 2 * ring_.size())); // callbacks of the node's own
    }
    Entry &entry   = ring_[(head_ + count_) % ring_.size()];
    entry.callback = callback;
    entry.owner_id = owner_id;
    ++count_;
}

void CallbackQueue::removeByID(std::uint64_t owner_id)
{
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i)
    {
        Entry &entry = ring_[(head_ + i) % ring_.size()];
        if (entry.owner_id == owner_id)
        {
            entry.callback.reset();
        }
        else if (kept++ != i)
        {
            std::swap(ring_[(head_ + kept - 1) % ring_.size()], entry);
        }
    }
    count_ = kept;
}

void CallbackQueue::clear()
{
    for (Entry &entry : ring_)
    {
        entry.callback.reset();
    }
    count_ = 0;
}

bool CallbackQueue::waitForCallback(WallDuration timeout)
{
    const std::int64_t until = roscfe::now_ns() + timeout.toNSec();
    roscfe::pump(0);
    roscfe::run_async();
    while (empty() && !roscfe::g_node.shutting_down && roscfe::now_ns() < until)
    {
        roscfe::pump(until);
        roscfe::run_async();
    }
    return !empty();
}

CallbackQueue::CallOneResult CallbackQueue::callFirst()
{
    Entry                entry;
    const std::size_t    at       = head_;
    CallbackInterfacePtr callback = ring_[at].callback;
    entry.owner_id                = ring_[at].owner_id;
    ring_[at].callback.reset();
    head_ = (head_ + 1) % ring_.size();
    --count_;
    if (!callback->ready() || callback->call() == CallbackInterface::TryAgain)
    {
        addCallback(callback, entry.owner_id);
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
    return waitForCallback(timeout) ? callFirst() : Empty;
}

void CallbackQueue::callAvailable(WallDuration timeout)
{
    if (!enabled_ || !waitForCallback(timeout))
    {
        return;
    }
    // Those that are there now; what callbacks add waits for the next time.
    for (std::size_t left = count_; left > 0 && count_ > 0 && enabled_; --left)
    {
        callFirst();
    }
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
