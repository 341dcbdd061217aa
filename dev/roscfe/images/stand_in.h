// A stand-in for cFE and OSAL on a bare computer: tasks that give way when they wait, pipes, and a clock that goes on when all
// of them wait. It has the calls that a talker and a listener make, and refuses the rest.
#ifndef STAND_IN_H
#define STAND_IN_H

#include <cstdint>

namespace stand_in
{

void              write(const char *text); // on the console
[[noreturn]] void stop(int status);
[[noreturn]] void fly(); // run all applications

// An application of the image.
struct App
{
    const char *name;
    void (*entry)();
};
extern const App kApps[];
extern const int kAppCount;

constexpr std::int64_t kSecond = 1000000000;
extern const std::int64_t kFlight; // until ES asks the applications to end

} // namespace stand_in

#endif
