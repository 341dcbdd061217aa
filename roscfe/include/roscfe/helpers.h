// Threads that the library has for a node of the host. In other nodes these functions are missing.
#ifndef ROSCFE_HELPERS_H
#define ROSCFE_HELPERS_H

#include "ros/callback_queue.h"
#include "ros/duration.h"

namespace roscfe
{

struct Helper;

// Start a thread, which ends when its flag says so. Null when there is no task for it.
__attribute__((weak, visibility("hidden"))) Helper *start_helper(void (*run)(void *, const bool &is_stopped),
                                                                 void *argument);
__attribute__((weak, visibility("hidden"))) Helper *start_spinner(ros::CallbackQueue *queue);

// Stop a thread, and wait for its end.
__attribute__((weak, visibility("hidden"))) void stop_helper(Helper *helper);

// Let a thread look again at what it waits for.
__attribute__((weak, visibility("hidden"))) void wake_helper(Helper *helper);

// Wait in a thread, until it is woken or for a duration at most.
__attribute__((weak, visibility("hidden"))) void wait_in_helper(const ros::WallDuration &most);

} // namespace roscfe

#endif
