// Threads of a node. The library has the state of one task, so threads take turns: each is a child task of the
// application, and runs until it waits. One more child task takes over what comes through the pipe, as roscpp's threads
// for sockets do, so that every other one can wait for what it wants.
#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)

#include "turns.h"

#include <cstdio>

#include "roscfe/refuse.h"

namespace roscfe
{

namespace
{

constexpr std::size_t kStackBytes = 262144; // of a thread: nodes for the host are written for stacks of megabytes

// Guarded by the mutex of the condition variable: whose turn it is. All else that the node has is guarded by the turn.
osal_id_t     g_turns   = OS_OBJECT_ID_UNDEFINED;
std::uint32_t g_served  = 0; // the number of who runs: at first of the main thread
std::uint32_t g_next    = 1; // the number of who asks next
std::uint32_t g_changes = 0;

Thread        g_main;
Thread        g_receiver;
Thread *      g_begun    = nullptr; // those whose tasks have not begun yet, and that no task was created for
std::uint32_t g_created  = 0; // tasks
std::uint32_t g_living   = 0; // threads of the node that have begun, without the main one
bool          g_is_asked = false; // the main thread is to create tasks
bool          g_is_receiving = false; // the receiver has begun

thread_local Thread *t_current = nullptr; // null in the main thread

void lock_turns()
{
    if (OS_CondVarLock(g_turns) != OS_SUCCESS)
    {
        refuse("threads", "OS_CondVarLock failed");
    }
}

// Wait for the turn, and unlock.
void await_turn()
{
    const std::uint32_t number = g_next++;
    while (g_served != number)
    {
        OS_CondVarWait(g_turns);
    }
    OS_CondVarUnlock(g_turns);
}

void give_turn()
{
    lock_turns();
    ++g_served;
    OS_CondVarBroadcast(g_turns);
    OS_CondVarUnlock(g_turns);
}

void take_turn()
{
    lock_turns();
    await_turn();
}

// ES does not delete it with its application: one that was killed and started again finds it, in an unknown state.
bool create_turns()
{
    char name[OS_MAX_API_NAME];
    own_name(name, "_TURN", "_U");
    osal_id_t old = OS_OBJECT_ID_UNDEFINED;
    if (OS_CondVarGetIdByName(&old, name) == OS_SUCCESS)
    {
        OS_CondVarDelete(old);
    }
    return OS_CondVarCreate(&g_turns, name, 0) == OS_SUCCESS;
}

void append(Thread *&list, Thread *thread)
{
    Thread **last = &list;
    while (*last != nullptr)
    {
        last = &(*last)->next;
    }
    *last = thread;
}

void remove(Thread *&list, const Thread *thread)
{
    for (Thread **at = &list; *at != nullptr; at = &(*at)->next)
    {
        if (*at == thread)
        {
            *at = thread->next;
            return;
        }
    }
}

extern "C" void roscfe_begin_thread()
{
    take_turn();
    Thread *thread = g_begun;
    while (thread != nullptr && !thread->has_task)
    {
        thread = thread->next;
    }
    if (thread != nullptr) // there are as many as tasks
    {
        remove(g_begun, thread);
        t_current = thread;
        g_living += thread != &g_receiver ? 1 : 0;
        thread->result = thread->start(thread->argument);
    }
    end_thread();
}

void create_task(Thread *thread)
{
    OS_task_prop_t own{};
    char           end[16];
    char           name[OS_MAX_API_NAME];
    std::snprintf(end, sizeof end, "_T%lu", static_cast<unsigned long>(g_created + 1));
    own_name(name, end, end);
    CFE_ES_TaskId_t id = CFE_ES_TASKID_UNDEFINED;
    bool is_created    = OS_TaskGetInfo(OS_TaskGetId(), &own) == OS_SUCCESS;
    // What takes packets over asks for its turn as soon as one comes: it is more urgent than whom they are for.
    const std::uint32_t less     = thread == &g_receiver && own.priority > 1 ? 1 : 0;
    const auto          priority = as<CFE_ES_TaskPriority_Atom_t>(own.priority - less);
    is_created = is_created && CFE_ES_CreateChildTask(&id, name, roscfe_begin_thread, CFE_ES_TASK_STACK_ALLOCATE,
                                                      kStackBytes, priority, 0) == CFE_SUCCESS;
    thread->has_task = is_created;
    thread->has_failed = !thread->has_task;
    if (thread->has_task)
    {
        ++g_created;
    }
    else
    {
        remove(g_begun, thread);
        CFE_EVS_SendEvent(kWaitEid, CFE_EVS_EventType_ERROR, "%s: no task for a thread: CFE_ES_CreateChildTask failed",
                          g_node.name.c_str());
    }
}

// ES creates tasks for an application's main task only.
void create_tasks()
{
    g_is_asked = false;
    for (Thread *thread = g_begun, *next = nullptr; thread != nullptr; thread = next)
    {
        next = thread->next;
        if (!thread->has_task)
        {
            create_task(thread);
        }
    }
    tell_change();
}

void ask_for_task(Thread *thread)
{
    append(g_begun, thread);
    if (t_current == nullptr)
    {
        create_task(thread);
    }
    else
    {
        g_is_asked = true;
        tell_change();
    }
}

// Have a task created for a thread, unless it has one. False when there is none for it.
bool get_task(Thread *thread)
{
    if (thread->has_task)
    {
        return true;
    }
    thread->has_failed = false;
    ask_for_task(thread);
    while (!thread->has_task && !thread->has_failed)
    {
        wait_a_while(kForever); // until the main thread waits
    }
    return thread->has_task;
}

void *receive_for_ever(void *)
{
    g_is_receiving = true;
    for (;;)
    {
        give_turn();
        const CFE_SB_Buffer_t *packet = wait_in_pipe();
        take_turn();
        if (packet == nullptr)
        {
            return nullptr; // the pipe is gone
        }
        take_packet(packet);
        tell_change();
    }
}

} // namespace

bool has_threads()
{
    return g_created > 0;
}

bool has_receiver()
{
    return g_is_receiving;
}

Thread *current_thread()
{
    return t_current != nullptr ? t_current : &g_main;
}

void receive_in_thread()
{
    if (has_threads() && !get_task(&g_receiver))
    {
        refuse("threads", "no task for the one that takes packets over");
    }
}

bool start_thread(Thread *thread)
{
    if (!OS_ObjectIdDefined(g_turns) && !create_turns())
    {
        g_turns = OS_OBJECT_ID_UNDEFINED;
        return false;
    }
    g_receiver.start = receive_for_ever;
    return (!g_node.has_pipe || get_task(&g_receiver)) && get_task(thread);
}

void end_thread()
{
    Thread *thread = t_current;
    if (thread != nullptr)
    {
        destroy_locals(thread);
        g_living -= thread != &g_receiver ? 1 : 0;
        thread->is_done = true;
        if (thread->is_detached)
        {
            delete thread;
        }
    }
    tell_change();
    give_turn();
    for (;;)
    {
        CFE_ES_ExitChildTask();
    }
}

void leave_thread()
{
    if (t_current != nullptr)
    {
        end_thread();
    }
    while (g_living > 0 || g_begun != nullptr)
    {
        wait_a_while(kForever);
    }
    end(0);
}

void *join_thread(Thread *thread)
{
    while (!thread->is_done)
    {
        wait_a_while(kForever);
    }
    void *result = thread->result;
    delete thread;
    return result;
}

void wait_a_while(std::int64_t until_ns)
{
    pump(until_ns, true);
    if (run_async != nullptr)
    {
        run_async();
    }
}

void tell_change()
{
    if (has_threads())
    {
        lock_turns();
        ++g_changes;
        OS_CondVarBroadcast(g_turns);
        OS_CondVarUnlock(g_turns);
    }
}

void let_others_run()
{
    if (!has_threads())
    {
        return;
    }
    if (g_is_asked && t_current == nullptr)
    {
        create_tasks();
    }
    lock_turns();
    if (g_next != g_served + 1)
    {
        ++g_served;
        OS_CondVarBroadcast(g_turns);
        await_turn();
    }
    else
    {
        OS_CondVarUnlock(g_turns);
    }
}

void wait_in_turn(std::int64_t until_ns)
{
    if (g_is_asked && t_current == nullptr)
    {
        create_tasks();
        return; // the threads that asked look again
    }
    const OS_time_t until = OS_TimeFromTotalNanoseconds(until_ns + OS_TIME_TICK_RESOLUTION_NS - 1);
    lock_turns();
    const std::uint32_t before = g_changes;
    ++g_served;
    OS_CondVarBroadcast(g_turns);
    std::int32_t status = OS_SUCCESS;
    while (g_changes == before && status == OS_SUCCESS)
    {
        status = until_ns == kForever ? OS_CondVarWait(g_turns) : OS_CondVarTimedWait(g_turns, &until);
    }
    await_turn();
}

} // namespace roscfe

#endif
