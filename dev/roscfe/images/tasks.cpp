// Tasks of the stand-in: one runs until it waits, then the next that is ready does.
#include "tasks.h"

namespace stand_in
{

namespace
{

constexpr std::uint32_t kUnused     = 0xA5A5A5A5; // what a stack is filled with
constexpr std::size_t   kStackWords = 1536;

struct Task
{
    std::uint32_t *sp       = nullptr;
    bool           ended    = false;
    bool           is_ready = true;
    std::int64_t   until    = kNever;
    const void *   on       = nullptr;
    alignas(8) std::uint32_t stack[kStackWords];
};

Task           g_tasks[kMostTasks];
int            g_current = -1;
std::int64_t   g_now     = 100 * kSecond;
std::uint32_t *g_scheduler_sp;

// Keep the registers of one task on its stack, and take those of another.
__attribute__((naked)) void change(std::uint32_t **, std::uint32_t *)
{
    __asm__ volatile("push {r4-r11, lr}\n"
                     "vpush {s16-s31}\n"
                     "str sp, [r0]\n"
                     "mov sp, r1\n"
                     "vpop {s16-s31}\n"
                     "pop {r4-r11, pc}\n");
}

void begin_task()
{
    kApps[g_current].entry();
    end_task();
}

} // namespace

int current_task()
{
    return g_current;
}

std::int64_t now()
{
    return g_now;
}

bool wait(std::int64_t until, const void *on)
{
    Task &task    = g_tasks[g_current];
    task.is_ready = false;
    task.until    = until;
    task.on       = on;
    change(&task.sp, g_scheduler_sp);
    return task.on == nullptr;
}

void wake(const void *on)
{
    for (Task &each : g_tasks)
    {
        if (!each.is_ready && each.on == on && on != nullptr)
        {
            each.is_ready = true;
            each.on       = nullptr;
        }
    }
}

void end_task()
{
    g_tasks[g_current].ended = true;
    change(&g_tasks[g_current].sp, g_scheduler_sp);
    stop(3); // it never comes back
}

std::size_t stack_used(int task)
{
    std::size_t unused = 0;
    while (unused < kStackWords && g_tasks[task].stack[unused] == kUnused)
    {
        ++unused;
    }
    return (kStackWords - unused) * sizeof(std::uint32_t);
}

bool run_next()
{
    Task *       next  = nullptr;
    std::int64_t first = kNever;
    for (int i = 0; i < kAppCount && next == nullptr; ++i)
    {
        Task &task = g_tasks[i];
        if (task.ended)
        {
            continue;
        }
        if (task.is_ready || task.until <= g_now)
        {
            next      = &task;
            g_current = i;
        }
        else if (task.until < first)
        {
            first = task.until;
        }
    }
    if (next == nullptr)
    {
        g_now = first;
        return first != kNever;
    }
    next->is_ready = true;
    change(&g_scheduler_sp, next->sp);
    return true;
}

void begin_tasks()
{
    constexpr std::size_t kSaved = 16 + 9; // s16-s31, r4-r11 and the return address
    for (int i = 0; i < kAppCount; ++i)
    {
        Task &task = g_tasks[i];
        for (std::uint32_t &each : task.stack)
        {
            each = kUnused;
        }
        task.sp             = task.stack + kStackWords - kSaved - 2; // so that the stack is aligned to 8 bytes
        task.sp[kSaved - 1] = reinterpret_cast<std::uint32_t>(&begin_task);
    }
}

} // namespace stand_in
