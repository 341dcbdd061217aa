// Asynchronous spinners, and callbacks that run while the node waits: what other threads would do in ROS.
#include <algorithm>

#include "core/core.h"
#include "ros/spinner.h"
#include "roscfe/helpers.h"
#include "roscfe/waiting.h"

namespace ros
{

AsyncSpinner::AsyncSpinner(std::uint32_t, CallbackQueue *queue) : queue_(queue) {}

void AsyncSpinner::start()
{
    if (!started_)
    {
        started_ = true;
        CallbackQueue *queue = queue_ != nullptr ? queue_ : &roscfe::g_node.queue;
        thread_              = roscfe::start_spinner != nullptr ? roscfe::start_spinner(queue) : nullptr;
        if (thread_ == nullptr)
        {
            roscfe::start_async(queue);
        }
    }
}

void AsyncSpinner::stop()
{
    if (started_)
    {
        started_ = false;
        if (thread_ != nullptr)
        {
            roscfe::stop_helper(thread_);
            thread_ = nullptr;
        }
        else
        {
            roscfe::stop_async(queue_ != nullptr ? queue_ : &roscfe::g_node.queue);
        }
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
