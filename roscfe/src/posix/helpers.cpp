// Threads that the library has for a node of the host: asynchronous spinners, and the execute callbacks of actions.
#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)

#include "ros/callback_queue.h"
#include "ros/duration.h"
#include "roscfe/helpers.h"
#include "turns.h"

namespace roscfe
{

struct Helper
{
    Thread thread;
    void (*run)(void *, const bool &);
    void *argument;
    bool  is_stopped = false;
};

namespace
{

void *run_helper(void *argument)
{
    auto *helper = static_cast<Helper *>(argument);
    helper->run(helper->argument, helper->is_stopped);
    return nullptr;
}

void spin_queue(void *queue, const bool &is_stopped)
{
    while (!is_stopped && !g_node.shutting_down)
    {
        static_cast<ros::CallbackQueue *>(queue)->callAvailable(ros::WallDuration(0.1)); // how often roscpp's looks
        tell_change(); // others may wait for what a callback did
    }
}

} // namespace

Helper *start_helper(void (*run)(void *, const bool &), void *argument)
{
    auto *helper            = new Helper{Thread(), run, argument};
    helper->thread.start    = run_helper;
    helper->thread.argument = helper;
    if (!start_thread(&helper->thread))
    {
        delete helper;
        return nullptr;
    }
    return helper;
}

void stop_helper(Helper *helper)
{
    helper->is_stopped = true;
    tell_change();
    if (current_thread() == &helper->thread)
    {
        return; // a callback of its own stops it; its memory remains
    }
    while (!helper->thread.is_done)
    {
        wait_a_while(kForever);
    }
    delete helper;
}

void wake_helper(Helper *)
{
    tell_change();
}

void wait_in_helper(const ros::WallDuration &most)
{
    wait_a_while(now_ns() + most.toNSec());
}

Helper *start_spinner(ros::CallbackQueue *queue)
{
    return start_helper(spin_queue, queue);
}

} // namespace roscfe

#endif
