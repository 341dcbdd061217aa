// POSIX's threads, mutexes, conditions and keys, on threads that take turns. They stand in the place of libc's: the linker
// finds them first, for the node's own code and for the headers that it includes.
#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <ctime>

#include <pthread.h>
#include <semaphore.h>

#include "../core/core.h"
#include "roscfe/refuse.h"
#include "roscfe/thread_waits.h"
#include "turns.h"

namespace roscfe
{

namespace
{

constexpr std::size_t kMostKeys     = 64;
constexpr int         kMostReaders  = 1 << 20;
constexpr int         kLongestCount = 0x7FFFFFFF; // of a semaphore

// What a thread waits for; the list is in the order in which the waits began.
struct Waiter
{
    explicit Waiter(const void *what) : thing(what)
    {
        Waiter **last = &g_first;
        while (*last != nullptr)
        {
            last = &(*last)->next;
        }
        *last = this;
    }
    ~Waiter()
    {
        Waiter **at = &g_first;
        while (*at != this)
        {
            at = &(*at)->next;
        }
        *at = next;
    }
    Waiter(const Waiter &) = delete;
    Waiter &operator=(const Waiter &) = delete;

    static Waiter *first() { return g_first; }

    const void *const thing;
    bool              is_woken = false;
    Waiter *          next     = nullptr;

  private:
    static Waiter *g_first;
};
Waiter *Waiter::g_first = nullptr;

void wake(const void *thing, bool all)
{
    for (Waiter *each = Waiter::first(); each != nullptr; each = each->next)
    {
        if (each->thing == thing && !each->is_woken)
        {
            each->is_woken = true;
            if (!all)
            {
                break;
            }
        }
    }
    tell_change();
}

std::int64_t ns_of(const timespec &time)
{
    return std::int64_t{time.tv_sec} * kSecond + time.tv_nsec;
}

// When a time of a clock of POSIX is, by the processor's.
std::int64_t until(clockid_t clock, const timespec *time)
{
    timespec now{};
    ::clock_gettime(clock, &now);
    return now_ns() + std::max<std::int64_t>(ns_of(*time) - ns_of(now), 0);
}

bool is_over(std::int64_t until_ns)
{
    return until_ns != kForever && now_ns() >= until_ns;
}

int number_of(const Thread *thread)
{
    // A mutex has room for a number only; 0 is nobody.
    return static_cast<int>((reinterpret_cast<std::uintptr_t>(thread) >> 4) & 0x3FFFFFFF) | 0x40000000;
}

// What the fields of glibc's type mean here: who holds it, how often, and its kind.
struct Mutex
{
    explicit Mutex(pthread_mutex_t *mutex) : holder(mutex->__data.__owner), count(mutex->__data.__count),
                                             kind(mutex->__data.__kind)
    {
    }

    int &         holder;
    unsigned int &count;
    int &         kind;
};

bool try_lock(const Mutex &mutex)
{
    const int self = number_of(current_thread());
    if (mutex.holder != 0 && (mutex.holder != self || (mutex.kind & 3) != PTHREAD_MUTEX_RECURSIVE))
    {
        return false;
    }
    mutex.holder = self;
    ++mutex.count;
    return true;
}

int lock(const Mutex &mutex, std::int64_t until_ns)
{
    let_others_run(); // those that are ready may lock it first
    while (!try_lock(mutex))
    {
        if (mutex.holder == number_of(current_thread()))
        {
            if (mutex.kind == PTHREAD_MUTEX_ERRORCHECK)
            {
                return EDEADLK;
            }
            if (until_ns == kForever)
            {
                refuse("a mutex", "the thread that holds it locks it again, and would wait for ever");
            }
        }
        if (is_over(until_ns))
        {
            return ETIMEDOUT;
        }
        wait_a_while(until_ns);
    }
    return 0;
}

// As glibc's: any thread may unlock a mutex of the usual kind.
int unlock(const Mutex &mutex)
{
    const bool is_usual = (mutex.kind & 3) == PTHREAD_MUTEX_NORMAL || (mutex.kind & 3) == PTHREAD_MUTEX_ADAPTIVE_NP;
    if (mutex.holder != number_of(current_thread()) && !is_usual)
    {
        return EPERM;
    }
    if (mutex.count > 0 && --mutex.count == 0)
    {
        mutex.holder = 0;
        tell_change();
    }
    return 0;
}

// -- readers and writers: of glibc's type, the number of readers, or the writer's number below 0 -------------------------

int &readers_of(pthread_rwlock_t *lock)
{
    return *reinterpret_cast<int *>(lock);
}

bool try_read(int &readers)
{
    const bool may = readers >= 0 && readers < kMostReaders;
    readers += may ? 1 : 0;
    return may;
}

bool try_write(int &readers)
{
    const bool may = readers == 0;
    readers        = may ? -number_of(current_thread()) : readers;
    return may;
}

int wait_to(bool (*try_it)(int &), int &state, std::int64_t until_ns)
{
    let_others_run();
    while (!try_it(state))
    {
        if (state == -number_of(current_thread()))
        {
            return EDEADLK; // it waits for itself
        }
        if (is_over(until_ns))
        {
            return ETIMEDOUT;
        }
        wait_a_while(until_ns);
    }
    return 0;
}

// -- keys --------------------------------------------------------------------------------------------------------------

struct Key
{
    bool is_there          = false;
    void (*destroy)(void *) = nullptr;
};
std::array<Key, kMostKeys> g_keys;

// -- semaphores --------------------------------------------------------------------------------------------------------

bool try_take(int &count)
{
    const bool may = count > 0;
    count -= may ? 1 : 0;
    return may;
}

int &count_of(sem_t *semaphore)
{
    return *reinterpret_cast<int *>(semaphore);
}

int failed(int error)
{
    errno = error;
    return -1;
}

} // namespace

void destroy_locals(Thread *thread)
{
    constexpr int kRounds = 4; // a destructor may set another value
    for (int round = 0; round < kRounds && thread->locals != nullptr; ++round)
    {
        void **values  = thread->locals;
        thread->locals = nullptr;
        for (std::size_t key = 0; key < kMostKeys; ++key)
        {
            if (values[key] != nullptr && g_keys[key].destroy != nullptr)
            {
                g_keys[key].destroy(values[key]);
            }
        }
        std::free(values);
    }
}

bool wait_condition(pthread_cond_t *condition, pthread_mutex_t *mutex, std::int64_t until_ns, const bool *ends)
{
    Waiter      waiter(condition);
    const Mutex held(mutex);
    if (unlock(held) != 0)
    {
        return true; // the caller looks again at once
    }
    while (!waiter.is_woken && !is_over(until_ns) && (ends == nullptr || !*ends))
    {
        wait_a_while(until_ns);
    }
    lock(held, kForever);
    return waiter.is_woken;
}

std::int64_t wait_end(std::int64_t rest_ns)
{
    return now_ns() + std::max<std::int64_t>(rest_ns, 0);
}

void wait_for_thread(std::int64_t until_ns, const bool *ends)
{
    while (!is_over(until_ns) && (ends == nullptr || !*ends))
    {
        wait_a_while(until_ns);
    }
}

void wait_for_change(std::int64_t until_ns)
{
    wait_a_while(until_ns);
}

void thread_has_news()
{
    tell_change();
}

void let_other_threads_run()
{
    let_others_run();
}

} // namespace roscfe

using roscfe::current_thread;
using roscfe::Mutex;
using roscfe::Thread;

namespace
{

// What the fields of glibc's types mean here.
struct Attributes
{
    int detach_state;
    int policy;
    int inherits;
    int priority;
};

struct ConditionAttributes
{
    clockid_t clock;
};

// Behind what PTHREAD_COND_INITIALIZER fills with zeros: CLOCK_REALTIME is 0.
struct Condition
{
    clockid_t clock;
};

template <class Fields, class Type>
Fields &fields_of(Type *thing)
{
    static_assert(sizeof(Fields) <= sizeof(Type), "glibc's type has room for them");
    return *reinterpret_cast<Fields *>(thing);
}

Thread *thread_of(pthread_t id)
{
    return reinterpret_cast<Thread *>(id);
}

pthread_t id_of(const Thread *thread)
{
    return roscfe::as<pthread_t>(reinterpret_cast<std::uintptr_t>(thread));
}

void *&local_of(pthread_key_t key)
{
    static void *nothing = nullptr;
    Thread *     thread  = current_thread();
    if (thread->locals == nullptr)
    {
        thread->locals = static_cast<void **>(std::calloc(roscfe::kMostKeys, sizeof(void *)));
    }
    return thread->locals != nullptr && key < roscfe::kMostKeys ? thread->locals[key] : nothing;
}

} // namespace

extern "C" {

// -- threads -----------------------------------------------------------------------------------------------------------

int pthread_attr_init(pthread_attr_t *attributes)
{
    fields_of<Attributes>(attributes) = {PTHREAD_CREATE_JOINABLE, SCHED_OTHER, PTHREAD_INHERIT_SCHED, 0};
    return 0;
}
int pthread_attr_destroy(pthread_attr_t *)
{
    return 0;
}
int pthread_attr_setdetachstate(pthread_attr_t *attributes, int state)
{
    fields_of<Attributes>(attributes).detach_state = state;
    return 0;
}
int pthread_attr_getdetachstate(const pthread_attr_t *attributes, int *state)
{
    *state = fields_of<const Attributes>(attributes).detach_state;
    return 0;
}
// All threads have the application's priority and one size of stack.
int pthread_attr_setstacksize(pthread_attr_t *, std::size_t)
{
    return 0;
}
int pthread_attr_setschedpolicy(pthread_attr_t *attributes, int policy)
{
    fields_of<Attributes>(attributes).policy = policy;
    return 0;
}
int pthread_attr_getschedpolicy(const pthread_attr_t *attributes, int *policy)
{
    *policy = fields_of<const Attributes>(attributes).policy;
    return 0;
}
int pthread_attr_setinheritsched(pthread_attr_t *attributes, int inherits)
{
    fields_of<Attributes>(attributes).inherits = inherits;
    return 0;
}
int pthread_attr_setschedparam(pthread_attr_t *attributes, const sched_param *parameters)
{
    fields_of<Attributes>(attributes).priority = parameters->sched_priority;
    return 0;
}
int pthread_attr_getschedparam(const pthread_attr_t *attributes, sched_param *parameters)
{
    parameters->sched_priority = fields_of<const Attributes>(attributes).priority;
    return 0;
}
int pthread_setschedparam(pthread_t, int, const sched_param *)
{
    return 0;
}
int pthread_getschedparam(pthread_t, int *policy, sched_param *parameters)
{
    *policy                    = SCHED_OTHER;
    parameters->sched_priority = 0;
    return 0;
}
int pthread_setname_np(pthread_t, const char *)
{
    return 0;
}

int pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*start)(void *), void *argument)
{
    auto *thread     = new Thread;
    thread->start    = start;
    thread->argument = argument;
    thread->is_detached =
        attributes != nullptr && fields_of<const Attributes>(attributes).detach_state == PTHREAD_CREATE_DETACHED;
    *id = id_of(thread);
    if (!roscfe::start_thread(thread))
    {
        delete thread;
        return EAGAIN;
    }
    return 0;
}
int pthread_join(pthread_t id, void **result)
{
    if (thread_of(id) == current_thread())
    {
        return EDEADLK;
    }
    void *ended = roscfe::join_thread(thread_of(id));
    if (result != nullptr)
    {
        *result = ended;
    }
    return 0;
}
int pthread_detach(pthread_t id)
{
    Thread *thread = thread_of(id);
    if (thread->is_done)
    {
        delete thread;
    }
    else
    {
        thread->is_detached = true;
    }
    return 0;
}
pthread_t pthread_self()
{
    return id_of(current_thread());
}
int pthread_equal(pthread_t one, pthread_t other)
{
    return one == other ? 1 : 0;
}
[[noreturn]] void pthread_exit(void *result)
{
    current_thread()->result = result;
    roscfe::leave_thread();
}
int pthread_cancel(pthread_t)
{
    roscfe::refuse("pthread_cancel", "a task of cFE cannot be ended from another one at any place");
}
int pthread_kill(pthread_t, int)
{
    roscfe::refuse("pthread_kill", "signals belong to the processor");
}
int pthread_sigmask(int, const sigset_t *, sigset_t *)
{
    return 0;
}
int pthread_setcancelstate(int, int *before)
{
    if (before != nullptr)
    {
        *before = PTHREAD_CANCEL_ENABLE;
    }
    return 0;
}
void pthread_testcancel() {}
int  sched_yield()
{
    roscfe::let_others_run();
    return 0;
}

// Threads take turns, so one that waits finds that another one has begun, and is told of its end.
int pthread_once(pthread_once_t *control, void (*function)())
{
    constexpr int kBegun = 1;
    constexpr int kDone  = 2;
    while (*control == kBegun)
    {
        roscfe::wait_a_while(roscfe::kForever);
    }
    if (*control != kDone)
    {
        struct Attempt // an exception leaves it as if it had never begun
        {
            pthread_once_t &state;
            pthread_once_t  outcome;
            ~Attempt()
            {
                state = outcome;
                roscfe::tell_change();
            }
        } attempt{*control, 0};
        *control = kBegun;
        function();
        attempt.outcome = kDone;
    }
    return 0;
}

// -- mutexes -----------------------------------------------------------------------------------------------------------

int pthread_mutexattr_init(pthread_mutexattr_t *attributes)
{
    fields_of<int>(attributes) = PTHREAD_MUTEX_NORMAL;
    return 0;
}
int pthread_mutexattr_destroy(pthread_mutexattr_t *)
{
    return 0;
}
int pthread_mutexattr_settype(pthread_mutexattr_t *attributes, int kind)
{
    fields_of<int>(attributes) = kind;
    return 0;
}
int pthread_mutexattr_setprotocol(pthread_mutexattr_t *, int)
{
    return 0;
}
int pthread_mutex_init(pthread_mutex_t *mutex, const pthread_mutexattr_t *attributes)
{
    *mutex = PTHREAD_MUTEX_INITIALIZER;
    Mutex(mutex).kind = attributes != nullptr ? fields_of<const int>(attributes) : PTHREAD_MUTEX_NORMAL;
    return 0;
}
int pthread_mutex_destroy(pthread_mutex_t *mutex)
{
    return Mutex(mutex).holder == 0 ? 0 : EBUSY;
}
int pthread_mutex_lock(pthread_mutex_t *mutex)
{
    return roscfe::lock(Mutex(mutex), roscfe::kForever);
}
int pthread_mutex_trylock(pthread_mutex_t *mutex)
{
    roscfe::let_others_run();
    return roscfe::try_lock(Mutex(mutex)) ? 0 : EBUSY;
}
int pthread_mutex_timedlock(pthread_mutex_t *mutex, const timespec *time)
{
    return roscfe::lock(Mutex(mutex), roscfe::until(CLOCK_REALTIME, time));
}
int pthread_mutex_clocklock(pthread_mutex_t *mutex, clockid_t clock, const timespec *time)
{
    return roscfe::lock(Mutex(mutex), roscfe::until(clock, time));
}
int pthread_mutex_unlock(pthread_mutex_t *mutex)
{
    return roscfe::unlock(Mutex(mutex));
}

// -- conditions --------------------------------------------------------------------------------------------------------

int pthread_condattr_init(pthread_condattr_t *attributes)
{
    fields_of<ConditionAttributes>(attributes).clock = CLOCK_REALTIME;
    return 0;
}
int pthread_condattr_destroy(pthread_condattr_t *)
{
    return 0;
}
int pthread_condattr_setclock(pthread_condattr_t *attributes, clockid_t clock)
{
    fields_of<ConditionAttributes>(attributes).clock = clock;
    return 0;
}
int pthread_cond_init(pthread_cond_t *condition, const pthread_condattr_t *attributes)
{
    fields_of<Condition>(condition).clock =
        attributes != nullptr ? fields_of<const ConditionAttributes>(attributes).clock : CLOCK_REALTIME;
    return 0;
}
int pthread_cond_destroy(pthread_cond_t *)
{
    return 0;
}
int pthread_cond_wait(pthread_cond_t *condition, pthread_mutex_t *mutex)
{
    roscfe::wait_condition(condition, mutex, roscfe::kForever, nullptr);
    return 0;
}
int pthread_cond_clockwait(pthread_cond_t *condition, pthread_mutex_t *mutex, clockid_t clock, const timespec *time)
{
    return roscfe::wait_condition(condition, mutex, roscfe::until(clock, time), nullptr) ? 0 : ETIMEDOUT;
}
int pthread_cond_timedwait(pthread_cond_t *condition, pthread_mutex_t *mutex, const timespec *time)
{
    return pthread_cond_clockwait(condition, mutex, fields_of<Condition>(condition).clock, time);
}
int pthread_cond_signal(pthread_cond_t *condition)
{
    roscfe::wake(condition, false);
    return 0;
}
int pthread_cond_broadcast(pthread_cond_t *condition)
{
    roscfe::wake(condition, true);
    return 0;
}

// -- readers and writers -----------------------------------------------------------------------------------------------

int pthread_rwlock_init(pthread_rwlock_t *lock, const pthread_rwlockattr_t *)
{
    roscfe::readers_of(lock) = 0;
    return 0;
}
int pthread_rwlock_destroy(pthread_rwlock_t *lock)
{
    return roscfe::readers_of(lock) == 0 ? 0 : EBUSY;
}
int pthread_rwlock_rdlock(pthread_rwlock_t *lock)
{
    return roscfe::wait_to(roscfe::try_read, roscfe::readers_of(lock), roscfe::kForever);
}
int pthread_rwlock_wrlock(pthread_rwlock_t *lock)
{
    return roscfe::wait_to(roscfe::try_write, roscfe::readers_of(lock), roscfe::kForever);
}
int pthread_rwlock_tryrdlock(pthread_rwlock_t *lock)
{
    return roscfe::try_read(roscfe::readers_of(lock)) ? 0 : EBUSY;
}
int pthread_rwlock_trywrlock(pthread_rwlock_t *lock)
{
    return roscfe::try_write(roscfe::readers_of(lock)) ? 0 : EBUSY;
}
int pthread_rwlock_clockrdlock(pthread_rwlock_t *lock, clockid_t clock, const timespec *time)
{
    return roscfe::wait_to(roscfe::try_read, roscfe::readers_of(lock), roscfe::until(clock, time));
}
int pthread_rwlock_clockwrlock(pthread_rwlock_t *lock, clockid_t clock, const timespec *time)
{
    return roscfe::wait_to(roscfe::try_write, roscfe::readers_of(lock), roscfe::until(clock, time));
}
int pthread_rwlock_timedrdlock(pthread_rwlock_t *lock, const timespec *time)
{
    return pthread_rwlock_clockrdlock(lock, CLOCK_REALTIME, time);
}
int pthread_rwlock_timedwrlock(pthread_rwlock_t *lock, const timespec *time)
{
    return pthread_rwlock_clockwrlock(lock, CLOCK_REALTIME, time);
}
int pthread_rwlock_unlock(pthread_rwlock_t *lock)
{
    int &readers = roscfe::readers_of(lock);
    readers      = readers > 0 ? readers - 1 : 0;
    roscfe::tell_change();
    return 0;
}

// -- keys --------------------------------------------------------------------------------------------------------------

int pthread_key_create(pthread_key_t *key, void (*destroy)(void *))
{
    for (pthread_key_t each = 0; each < roscfe::kMostKeys; ++each)
    {
        if (!roscfe::g_keys[each].is_there)
        {
            roscfe::g_keys[each] = {true, destroy};
            *key                 = each;
            return 0;
        }
    }
    return EAGAIN;
}
int pthread_key_delete(pthread_key_t key)
{
    if (key >= roscfe::kMostKeys)
    {
        return EINVAL;
    }
    roscfe::g_keys[key] = roscfe::Key();
    return 0;
}
void *pthread_getspecific(pthread_key_t key)
{
    return local_of(key);
}
int pthread_setspecific(pthread_key_t key, const void *value)
{
    local_of(key) = const_cast<void *>(value);
    return 0;
}

// -- semaphores --------------------------------------------------------------------------------------------------------

int sem_init(sem_t *semaphore, int, unsigned int value)
{
    if (value > static_cast<unsigned int>(roscfe::kLongestCount))
    {
        return roscfe::failed(EINVAL);
    }
    roscfe::count_of(semaphore) = static_cast<int>(value);
    return 0;
}
int sem_destroy(sem_t *)
{
    return 0;
}
int sem_wait(sem_t *semaphore)
{
    return roscfe::wait_to(roscfe::try_take, roscfe::count_of(semaphore), roscfe::kForever);
}
int sem_trywait(sem_t *semaphore)
{
    return roscfe::try_take(roscfe::count_of(semaphore)) ? 0 : roscfe::failed(EAGAIN);
}
int sem_timedwait(sem_t *semaphore, const timespec *time)
{
    const std::int64_t end = roscfe::until(CLOCK_REALTIME, time);
    return roscfe::wait_to(roscfe::try_take, roscfe::count_of(semaphore), end) == 0 ? 0 : roscfe::failed(ETIMEDOUT);
}
int sem_post(sem_t *semaphore)
{
    ++roscfe::count_of(semaphore);
    roscfe::tell_change();
    return 0;
}
int sem_getvalue(sem_t *semaphore, int *value)
{
    *value = roscfe::count_of(semaphore);
    return 0;
}

} // extern "C"

#endif
