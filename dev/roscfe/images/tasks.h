// Tasks of the stand-in, and the time.
#ifndef STAND_IN_TASKS_H
#define STAND_IN_TASKS_H

#include <cstddef>
#include <cstdint>

#include "stand_in.h"

namespace stand_in
{

constexpr int          kMostTasks = 2;
constexpr std::int64_t kNever     = INT64_MAX;

void begin_tasks();
bool run_next(); // a task that is ready, or let the time go on; false when all have ended or wait for ever

int          current_task();
std::int64_t now();

// Of the task that runs: wait until a time or for a thing; true when that was woken.
bool wait(std::int64_t until, const void *on = nullptr);
void wake(const void *on);
[[noreturn]] void end_task();

std::size_t stack_used(int task); // bytes

} // namespace stand_in

#endif
