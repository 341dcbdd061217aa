// The start of an image on a bare Cortex-M: memory, constructors, and the end by semihosting.
#include <cstdint>
#include <cstring>

#include "stand_in.h"

extern "C" {

extern std::uint32_t data_begin, data_end, data_source, bss_begin, bss_end, stack_top;
typedef void (*Constructor)();
extern const Constructor init_begin, init_end;

void *__dso_handle = nullptr;

// Objects of a node stay until the processor stops: nothing is registered for an end.
int __cxa_atexit(void (*)(void *), void *, void *)
{
    return 0;
}
int __aeabi_atexit(void *, void (*)(void *), void *)
{
    return 0;
}

[[noreturn]] void reset()
{
    volatile std::uint32_t &access = *reinterpret_cast<volatile std::uint32_t *>(0xE000ED88);
    access                         = access | 0xF00000; // the floating-point unit
    __asm__ volatile("dsb\nisb");
    std::memcpy(&data_begin, &data_source, static_cast<std::size_t>(reinterpret_cast<char *>(&data_end) -
                                                                    reinterpret_cast<char *>(&data_begin)));
    std::memset(&bss_begin, 0, static_cast<std::size_t>(reinterpret_cast<char *>(&bss_end) -
                                                        reinterpret_cast<char *>(&bss_begin)));
    for (const Constructor *each = &init_begin; each != &init_end; ++each)
    {
        (*each)();
    }
    stand_in::fly();
}

void fault()
{
    stand_in::write("a fault of the processor\n");
    stand_in::stop(2);
}

__attribute__((section(".vectors"), used)) const void *const vectors[16] = {
    &stack_top, reinterpret_cast<const void *>(&reset), reinterpret_cast<const void *>(&fault),
    reinterpret_cast<const void *>(&fault), reinterpret_cast<const void *>(&fault), reinterpret_cast<const void *>(&fault),
    reinterpret_cast<const void *>(&fault)};

} // extern "C"

namespace stand_in
{

namespace
{

int semihost(int operation, const void *argument)
{
    register int         first __asm__("r0")  = operation;
    register const void *second __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(first) : "r"(second) : "memory");
    return first;
}

} // namespace

void write(const char *text)
{
    constexpr int kWriteText = 0x04;
    semihost(kWriteText, text);
}

void stop(int status)
{
    constexpr int            kExitExtended = 0x20;
    const std::uint32_t      words[2]      = {0x20026, static_cast<std::uint32_t>(status)}; // ADP_Stopped_ApplicationExit
    semihost(kExitExtended, words);
    for (;;)
    {
    }
}

} // namespace stand_in
