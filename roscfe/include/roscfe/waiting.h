// Callbacks that run while the node waits: what other threads would do in ROS.
#ifndef ROSCFE_WAITING_H
#define ROSCFE_WAITING_H

#include <cstdint>

#include "ros/callback_queue.h"
#include "ros/duration.h"
#include "ros/init.h"
#include "ros/time.h"

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

} // namespace roscfe

#endif
