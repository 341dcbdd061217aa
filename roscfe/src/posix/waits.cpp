// POSIX's waits, with which a node would stop its task without cFE's knowledge: it waits in its pipe. The linker puts these
// functions in their place (--wrap).
#include <ctime>

#include <unistd.h>

#include "../core/core.h"
#include "roscfe/parts.h"

namespace
{

void wait_for(std::int64_t ns)
{
    roscfe::parts::need(roscfe::parts::exact_waits);
    roscfe::wait_until(roscfe::now_ns() + ns);
}

} // namespace

extern "C" {

unsigned int __wrap_sleep(unsigned int seconds)
{
    wait_for(seconds * roscfe::kSecond);
    return 0;
}

int __wrap_usleep(useconds_t microseconds)
{
    wait_for(static_cast<std::int64_t>(microseconds) * 1000);
    return 0;
}

int __wrap_nanosleep(const struct timespec *request, struct timespec *rest)
{
    wait_for(request->tv_sec * roscfe::kSecond + request->tv_nsec);
    if (rest != nullptr)
    {
        *rest = timespec();
    }
    return 0;
}

} // extern "C"
