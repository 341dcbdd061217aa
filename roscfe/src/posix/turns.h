// Threads of a node, which take turns.
#ifndef ROSCFE_TURNS_H
#define ROSCFE_TURNS_H

#include <cstdint>

#include "../core/core.h"

namespace roscfe
{

struct Thread
{
    void *(*start)(void *) = nullptr;
    void *  argument       = nullptr;
    void *  result         = nullptr;
    Thread *next           = nullptr; // of those that are to begin
    void ** locals         = nullptr; // values of thread-specific keys
    bool    has_task       = false;
    bool    has_failed     = false; // no task could be created
    bool    is_done        = false;
    bool    is_detached    = false;
};

Thread *current_thread(); // never null

// Start a thread; the caller goes on first. False when there is no task for it.
bool start_thread(Thread *thread);

// End the calling thread: an object that is detached is deleted, any other one remains until another thread joins it.
[[noreturn]] void end_thread();

// End the calling thread at any place: the main one waits for all others, and ends the node then.
[[noreturn]] void leave_thread();

// Wait until a thread has ended, and delete its object.
void *join_thread(Thread *thread);

// Let other threads run until something changes or the time is over. Messages are taken over meanwhile.
void wait_a_while(std::int64_t until_ns);

// Tell waiting threads to look again at what they wait for.
void tell_change();

// Other threads that want to run do so before this one goes on.
void let_others_run();

// Destroy the calling thread's values of thread-specific keys (threads.cpp).
void destroy_locals(Thread *thread);

} // namespace roscfe

#endif
