// POSIX's clocks of the host: the processor's is the time, for a node as for its messages. The linker puts these functions in
// their place (--wrap).
#include <ctime>

#include <sys/time.h>

#include "../core/core.h"

extern "C" {

int __wrap_gettimeofday(struct timeval *time, void *)
{
    const std::int64_t now = roscfe::now_ns();
    time->tv_sec           = roscfe::as<decltype(time->tv_sec)>(now / roscfe::kSecond);
    time->tv_usec          = roscfe::as<decltype(time->tv_usec)>(now % roscfe::kSecond / 1000);
    return 0;
}

int __wrap_clock_gettime(clockid_t, struct timespec *time)
{
    const std::int64_t now = roscfe::now_ns();
    time->tv_sec           = roscfe::as<decltype(time->tv_sec)>(now / roscfe::kSecond);
    time->tv_nsec          = roscfe::as<decltype(time->tv_nsec)>(now % roscfe::kSecond);
    return 0;
}

} // extern "C"

