// Callbacks that run while the node waits: what other threads would do in ROS.
#ifndef ROSCFE_WAITING_H
#define ROSCFE_WAITING_H

#include <cstdint>
#include <utility>

#include "ros/callback_queue.h"
#include "ros/duration.h"
#include "ros/init.h"
#include "ros/time.h"
#include "roscfe/helpers.h"

namespace roscfe
{

// Callbacks of a queue run whenever the node waits, from now on and until they do no more.
void start_async(ros::CallbackQueue *queue);
void stop_async(ros::CallbackQueue *queue);

// Wait until a time in nanoseconds of the processor's clock, or until something came; what waits is called meanwhile.
// False when the time is over.
bool wait_for_news(std::int64_t until_ns);

// Wait until something is so, which is looked at with all news and ten times a second; 0 waits for ever. False when the
// time is over before, or the node is to end.
template <class F>
bool wait_until(const ros::Duration &timeout, F there)
{
    const ros::WallDuration look(0.1);
    const ros::Time         until = ros::Time::now() + timeout;
    while (!there())
    {
        if (!ros::ok())
        {
            return false;
        }
        const ros::Duration rest = until - ros::Time::now();
        if (!timeout.isZero() && rest <= ros::Duration())
        {
            return there();
        }
        const bool is_last = !timeout.isZero() && ros::Time::isSystemTime() && rest.toNSec() < look.toNSec();
        const auto now     = static_cast<std::int64_t>(ros::WallTime::now().toNSec());
        wait_for_news(now + (is_last ? rest.toNSec() : look.toNSec()));
    }
    return true;
}

// A queue whose callbacks run while the node waits, for as long as this object lives.
class WhileWaiting
{
  public:
    WhileWaiting() = default;
    ~WhileWaiting() { stop(); }
    WhileWaiting(const WhileWaiting &) = delete;
    WhileWaiting &operator=(const WhileWaiting &) = delete;

    void start(ros::CallbackQueue *queue)
    {
        stop();
        queue_ = queue;
        start_async(queue_);
    }
    void stop()
    {
        if (queue_ != nullptr)
        {
            stop_async(queue_);
            queue_ = nullptr;
        }
    }

  private:
    ros::CallbackQueue *queue_ = nullptr;
};

// A queue whose callbacks run in a thread of their own in a node for the host, and in other nodes while the node waits.
class OwnThread
{
  public:
    OwnThread() = default;
    ~OwnThread() { stop(); }
    OwnThread(const OwnThread &) = delete;
    OwnThread &operator=(const OwnThread &) = delete;

    void start(ros::CallbackQueue *queue)
    {
        stop();
        thread_ = start_spinner != nullptr ? start_spinner(queue) : nullptr;
        if (thread_ == nullptr)
        {
            waiting_.start(queue);
        }
    }
    void stop()
    {
        if (thread_ != nullptr)
        {
            stop_helper(std::exchange(thread_, nullptr));
        }
        waiting_.stop();
    }

  private:
    Helper *     thread_ = nullptr;
    WhileWaiting waiting_;
};

} // namespace roscfe

#endif
