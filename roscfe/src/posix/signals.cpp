// Signals belong to the processor, not to one of its applications: a node's handlers are kept, and none is installed.
// Those of SIGINT and SIGTERM run when the application is asked to end, as Ctrl-C and roslaunch would have them run.
// The linker puts these functions in the place of C's (--wrap).
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>

#include "../core/core.h"

namespace roscfe
{

using SignalHandler = void (*)(int);

namespace
{

constexpr int kMostSignals = 64;

std::array<struct sigaction, kMostSignals + 1> g_actions; // all of zeros is SIG_DFL

bool is_known(int number)
{
    return number > 0 && number <= kMostSignals && number != SIGKILL && number != SIGSTOP;
}

struct sigaction &action_of(int number) // a known one
{
    return g_actions[static_cast<std::size_t>(number)];
}

} // namespace

bool call_handler_of_end()
{
    for (const int number : {SIGINT, SIGTERM})
    {
        const struct sigaction action = action_of(number);
        if (action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN)
        {
            action_of(number) = {};
            if ((action.sa_flags & SA_SIGINFO) != 0)
            {
                siginfo_t info{};
                info.si_signo = number;
                action.sa_sigaction(number, &info, nullptr);
            }
            else
            {
                action.sa_handler(number);
            }
            return true;
        }
    }
    return false;
}

} // namespace roscfe

extern "C" {

int __wrap_sigaction(int number, const struct sigaction *action, struct sigaction *before)
{
    if (!roscfe::is_known(number))
    {
        errno = EINVAL;
        return -1;
    }
    if (before != nullptr)
    {
        *before = roscfe::action_of(number);
    }
    if (action != nullptr)
    {
        roscfe::action_of(number) = *action;
    }
    return 0;
}

roscfe::SignalHandler __wrap_signal(int number, roscfe::SignalHandler handler)
{
    struct sigaction action{};
    struct sigaction before{};
    action.sa_handler = handler;
    return __wrap_sigaction(number, &action, &before) == 0 ? before.sa_handler : SIG_ERR;
}

} // extern "C"
