// What nodes seldom ask of a queue of callbacks.
#include "core/core.h"
#include "ros/init.h"
#include "ros/spinner.h"

namespace ros
{

// Those that are being called are not among them.
void CallbackQueue::clear()
{
    for (; count_ > batch_; --count_)
    {
        at(count_ - 1).callback.reset();
    }
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

void spin(Spinner &spinner)
{
    spinner.spin();
}

} // namespace ros
