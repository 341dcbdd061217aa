// Waits of a thread of the node that another thread can end. Nodes for the host have them; threads take turns, and one
// that waits here lets the others run, and the node's messages be taken over.
#ifndef ROSCFE_THREAD_WAITS_H
#define ROSCFE_THREAD_WAITS_H

#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)
#error "roscfe: threads are not available in this profile, whose nodes are one task [thread]"
#endif

#include <cstdint>

#include <pthread.h>

namespace roscfe
{

constexpr std::int64_t kNoWaitEnd = -1;

// The end of a wait in nanoseconds of the processor's clock, for the other functions.
std::int64_t wait_end(std::int64_t rest_ns);

// Wait for a condition as pthread_cond_wait does, also until a flag is set or a time has come; kNoWaitEnd never comes.
// False when the condition was not signalled.
bool wait_condition(pthread_cond_t *condition, pthread_mutex_t *mutex, std::int64_t until_ns, const bool *ends);

// Wait until a time has come, or a flag is set.
void wait_for_thread(std::int64_t until_ns, const bool *ends);

// Wait until something has changed that a thread may wait for, or a time has come.
void wait_for_change(std::int64_t until_ns);

// Another thread's flag was set.
void thread_has_news();

void let_other_threads_run();

} // namespace roscfe

#endif
