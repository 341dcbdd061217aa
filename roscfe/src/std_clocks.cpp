// The clocks of C and of the C++ library: the processor's is the time, for a node as for its messages.
#include <chrono>
#include <ctime>

#include "core/core.h"

// The linker puts this function in the place of C's (--wrap).
extern "C" std::time_t __wrap_time(std::time_t *also)
{
    const auto now = roscfe::as<std::time_t>(roscfe::now_ns() / roscfe::kSecond);
    if (also != nullptr)
    {
        *also = now;
    }
    return now;
}

// -- std::chrono's clocks, which libstdc++ would ask the computer for: these have the names of its functions ------------

namespace roscfe
{

std::chrono::system_clock::time_point system_clock_now() noexcept __asm__("_ZNSt6chrono3_V212system_clock3nowEv");
std::chrono::steady_clock::time_point steady_clock_now() noexcept __asm__("_ZNSt6chrono3_V212steady_clock3nowEv");

std::chrono::system_clock::time_point system_clock_now() noexcept
{
    const std::chrono::nanoseconds now(now_ns());
    return std::chrono::system_clock::time_point(std::chrono::duration_cast<std::chrono::system_clock::duration>(now));
}

std::chrono::steady_clock::time_point steady_clock_now() noexcept
{
    return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(now_ns()));
}

} // namespace roscfe
