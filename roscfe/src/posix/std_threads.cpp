// What the C++ library has compiled of its threads: in place of it, on threads that take turns. All else of <thread>,
// <mutex>, <condition_variable> and <future> is in the headers, and calls POSIX's functions.
#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)

#include <cerrno>
#include <condition_variable>
#include <ctime>
#include <future>
#include <memory>
#include <thread>

#include "roscfe/thread_waits.h"
#include "turns.h"

namespace std
{

namespace
{

void *run(void *state)
{
    const unique_ptr<thread::_State> owned(static_cast<thread::_State *>(state));
    owned->_M_run();
    return nullptr;
}

} // namespace

void thread::_M_start_thread(_State_ptr state, void (*)())
{
    if (const int status = pthread_create(&_M_id._M_thread, nullptr, run, state.get()); status != 0)
    {
        __throw_system_error(status);
    }
    state.release(); // its task has it
}

void thread::join()
{
    const int status = joinable() ? pthread_join(_M_id._M_thread, nullptr) : EINVAL;
    if (status != 0)
    {
        __throw_system_error(status);
    }
    _M_id = id();
}

void thread::detach()
{
    const int status = joinable() ? pthread_detach(_M_id._M_thread) : EINVAL;
    if (status != 0)
    {
        __throw_system_error(status);
    }
    _M_id = id();
}

unsigned int thread::hardware_concurrency() noexcept
{
    return 1; // as they take turns
}

condition_variable::condition_variable() noexcept = default;
condition_variable::~condition_variable() noexcept = default;

void condition_variable::wait(unique_lock<mutex> &lock)
{
    pthread_cond_wait(native_handle(), lock.mutex()->native_handle());
}

void condition_variable::notify_one() noexcept
{
    pthread_cond_signal(native_handle());
}

void condition_variable::notify_all() noexcept
{
    pthread_cond_broadcast(native_handle());
}

// The state of a future is a number that the waiting thread looks at.
bool __atomic_futex_unsigned_base::_M_futex_wait_until(unsigned *number, unsigned value, bool has_end,
                                                       chrono::seconds seconds, chrono::nanoseconds ns)
{
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    const chrono::nanoseconds rest = seconds + ns - chrono::seconds(now.tv_sec) - chrono::nanoseconds(now.tv_nsec);
    const std::int64_t        end  = has_end ? roscfe::wait_end(rest.count()) : roscfe::kForever;
    while (__atomic_load_n(number, __ATOMIC_ACQUIRE) == value)
    {
        if (has_end && roscfe::now_ns() >= end)
        {
            return false;
        }
        roscfe::wait_a_while(end);
    }
    return true;
}

#if _GLIBCXX_RELEASE >= 11
bool __atomic_futex_unsigned_base::_M_futex_wait_until_steady(unsigned *number, unsigned value, bool has_end,
                                                              chrono::seconds seconds, chrono::nanoseconds ns)
{
    timespec now{};
    timespec steady{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    ::clock_gettime(CLOCK_MONOTONIC, &steady);
    seconds += chrono::seconds(now.tv_sec - steady.tv_sec);
    ns += chrono::nanoseconds(now.tv_nsec - steady.tv_nsec);
    return _M_futex_wait_until(number, value, has_end, seconds, ns);
}
#endif

void __atomic_futex_unsigned_base::_M_futex_notify_all(unsigned *)
{
    roscfe::tell_change();
}

} // namespace std

#endif
