// Asynchronous spinners of nodes for the host: a thread each.
#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)

#include "ros/callback_queue.h"
#include "ros/duration.h"
#include "turns.h"

namespace roscfe
{

namespace
{

struct SpinnerThread
{
    explicit SpinnerThread(ros::CallbackQueue *of) : queue(of) {}

    ros::CallbackQueue *queue;
    Thread              thread;
    bool                is_stopped = false;
};

void *spin_in_thread(void *argument)
{
    auto *spinner = static_cast<SpinnerThread *>(argument);
    while (!spinner->is_stopped && !g_node.shutting_down)
    {
        spinner->queue->callAvailable(ros::WallDuration(0.1)); // how often roscpp's looks
    }
    return nullptr;
}

} // namespace

void *start_spinner(ros::CallbackQueue *queue)
{
    auto *spinner            = new SpinnerThread(queue);
    spinner->thread.start    = spin_in_thread;
    spinner->thread.argument = spinner;
    if (!start_thread(&spinner->thread))
    {
        delete spinner;
        return nullptr;
    }
    return spinner;
}

void stop_spinner(void *thing)
{
    auto *spinner       = static_cast<SpinnerThread *>(thing);
    spinner->is_stopped = true;
    tell_change();
    if (current_thread() == &spinner->thread)
    {
        return; // a callback of its own stops it; its memory remains
    }
    while (!spinner->thread.is_done)
    {
        wait_a_while(kForever);
    }
    delete spinner;
}

} // namespace roscfe

#endif
