// What the core does for listeners, which are tested without a bus: nothing comes.
#include "ros/callback_queue.h"
#include "ros/time.h"
#include "roscfe/ground.h"
#include "roscfe/subscription.h"

namespace ros
{
Time Time::now()
{
    return Time(1000, 0);
}
CallbackQueue *getGlobalCallbackQueue()
{
    return nullptr;
}
} // namespace ros

namespace roscfe
{
Counters g_counters;
void subscribe(const boost::shared_ptr<Subscription> &, const char *, const char *, const char *) {}
} // namespace roscfe
