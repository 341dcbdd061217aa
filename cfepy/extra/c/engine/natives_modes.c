/* <fenv.h>, and how a function of libc computes as its caller would: with its rounding, its flags and its errno. */
#define _GNU_SOURCE
#include "natives.h"

#include <errno.h>
#include <fenv.h>

/* ---- the modes of either side ------------------------------------------------------------------------------------- */

#if defined(__x86_64__)
/* As the switch stores them: read in the same pieces, which is quicker. The x87's are slow to load, and hardly differ. */
typedef struct {
    uint32_t vectors;
    uint16_t control;
} Modes;
_Static_assert(sizeof(Modes) == sizeof(uint64_t), "float_modes are Modes");

static void take_modes(const uint64_t *modes, const uint64_t *before)
{
    const Modes *made = (const Modes *)modes;
    __asm__ volatile("ldmxcsr %0" : : "m"(made->vectors) : "memory");
    if (made->control != ((const Modes *)before)->control)
        __asm__ volatile("fldcw %0" : : "m"(made->control) : "memory");
}

static void keep_modes(uint64_t *modes)
{
    Modes *made = (Modes *)modes;
    __asm__ volatile("stmxcsr %0\n\tfnstcw %1" : "=m"(made->vectors), "=m"(made->control) : : "memory");
}

static bool rounds_as_host(const Coroutine *call)
{
    enum { ROUNDING = 0x6000, X87_ROUNDING = 0xC00 };
    const Modes *mine = (const Modes *)&call->float_modes, *host = (const Modes *)&call->host_float_modes;
    return ((mine->vectors ^ host->vectors) & ROUNDING) == 0 && ((mine->control ^ host->control) & X87_ROUNDING) == 0;
}

/* Words of the environment that fnstenv stores: the flags are in the second. */
HIDDEN void x87_set_flags(uint16_t flags)
{
    uint32_t environment[7];
    __asm__ volatile("fnstenv %0" : "=m"(environment));
    environment[1] = (environment[1] & ~0x3Fu) | flags;
    __asm__ volatile("fldenv %0" : : "m"(environment));
}
#else
static void take_modes(const uint64_t *modes, const uint64_t *before)
{
    uint64_t control = (uint32_t)*modes, status = *modes >> 32;
    __asm__ volatile("msr fpcr, %0\n\tmsr fpsr, %1" : : "r"(control), "r"(status) : "memory");
}

static void keep_modes(uint64_t *modes)
{
    uint64_t control, status;
    __asm__ volatile("mrs %0, fpcr\n\tmrs %1, fpsr" : "=r"(control), "=r"(status) : : "memory");
    *modes = (uint32_t)control | status << 32;
}

static bool rounds_as_host(const Coroutine *call)
{
    enum { ROUNDING = 3 << 22 };
    return ((call->float_modes ^ call->host_float_modes) & ROUNDING) == 0;
}
#endif

HIDDEN void modes_enter(Coroutine *call)
{
    call->has_modes = true;
    take_modes(&call->float_modes, &call->host_float_modes);
    errno = call->errno_before = 0;
}

static void to_host(Coroutine *call)
{
    if (call->has_modes)
        take_modes(&call->host_float_modes, &call->float_modes);
    if (call->host_locale != NULL)
        uselocale(call->host_locale);
    call->host_locale = NULL;
    call->has_modes = false;
}

static void leave(Coroutine *call)
{
    int error = errno;
    if (call->has_modes)
        keep_modes(&call->float_modes);
    to_host(call);
    if (error != call->errno_before)
        set_application_errno(call, error);
}

HIDDEN void modes_leave(Coroutine *call) { leave(call); }

HIDDEN void modes_leave_long(Coroutine *call)
{
    keep_flags(call);
    leave(call);
}

HIDDEN void modes_abandon(Coroutine *call)
{
    to_host(call);
    scan_abandon(call);
}

HIDDEN void libc_enter(Coroutine *call)
{
    call->host_locale = uselocale(only_locale());
    errno = call->errno_before = 0;
}

HIDDEN void libc_enter_to_compute(Coroutine *call)
{
    call->host_locale = uselocale(only_locale());
    modes_enter(call);
}

HIDDEN void libc_enter_to_print(Coroutine *call)
{
    call->host_locale = uselocale(only_locale());
    if (!rounds_as_host(call))
        modes_enter(call);
    errno = call->errno_before = application_errno(call); /* for %m */
}

HIDDEN void libc_leave(Coroutine *call)
{
    if (call->has_modes)
        keep_flags(call);
    leave(call);
}

/* ---- <fenv.h> ----------------------------------------------------------------------------------------------------- */

NATIVE(of_number)
{
    modes_enter(call);
    int result = ((int (*)(int))self->target)((int)WORD(0));
    modes_leave_long(call);
    return (uint64_t)(int64_t)result;
}

NATIVE(of_place)
{
    modes_enter(call);
    int result = ((int (*)(void *))self->target)(POINTER(0));
    modes_leave_long(call);
    return (uint64_t)(int64_t)result;
}

NATIVE(of_place_and_number)
{
    modes_enter(call);
    int result = ((int (*)(void *, int))self->target)(POINTER(0), (int)WORD(1));
    modes_leave_long(call);
    return (uint64_t)(int64_t)result;
}

/* As of_place; what x87 tells of its last instruction, which may be one of the host's, stays out of an application. */
NATIVE(keep_environment)
{
    uint64_t result = of_place(call, self);
#if defined(__x86_64__)
    fenv_t *kept = (fenv_t *)POINTER(0);
    kept->__eip = kept->__data_offset = 0;
    kept->__cs_selector = kept->__data_selector = 0;
    kept->__opcode = 0;
#endif
    return result;
}

HIDDEN const NativeRow natives_of_modes[] = {
    {"feclearexcept", of_number, (void *)feclearexcept},
    {"feraiseexcept", of_number, (void *)feraiseexcept},
    {"fetestexcept", of_number, (void *)fetestexcept},
    {"fesetround", of_number, (void *)fesetround},
    {"fegetround", of_number, (void *)fegetround},
    {"feenableexcept", of_number, (void *)feenableexcept},
    {"fedisableexcept", of_number, (void *)fedisableexcept},
    {"fegetexcept", of_number, (void *)fegetexcept},
    {"fegetexceptflag", of_place_and_number, (void *)fegetexceptflag},
    {"fesetexceptflag", of_place_and_number, (void *)fesetexceptflag},
    {"fegetenv", keep_environment, (void *)fegetenv},
    {"feholdexcept", keep_environment, (void *)feholdexcept},
    {"fesetenv", of_place, (void *)fesetenv},
    {"feupdateenv", of_place, (void *)feupdateenv},
    {NULL},
};
