/* libm: a row for each of its functions, in its three precisions. Each computes with the rounding of its caller, and its
 * flags and errno are the caller's afterwards.
 */
#define _GNU_SOURCE
#include "natives.h"

#include <math.h>
#include <string.h>

/* ---- arguments and results of each precision ---------------------------------------------------------------------- */

static double take(const Coroutine *call, int number) { return call->floats[number]; }
static uint64_t give(Coroutine *call, double value)
{
    call->float_result = value;
    return 0;
}

static float takef(const Coroutine *call, int number)
{
    float half;
    memcpy(&half, &call->floats[number], sizeof half);
    return half;
}
static uint64_t givef(Coroutine *call, float value)
{
    memcpy(&call->float_result, &value, sizeof value);
    return 0;
}

/* On x86-64 they are on the stack, and the number counts those alone; on aarch64 they are in registers, as the others. */
static long double takel(const Coroutine *call, int number)
{
    long double value;
#if defined(__x86_64__)
    memcpy(&value, call->stack_pointer + STACK_ARGUMENTS + 2 * number, 10);
#else
    memcpy(&value, &call->floats[number], 8);
    memcpy((char *)&value + 8, &call->float_highs[number], 8);
#endif
    return value;
}
static uint64_t givel(Coroutine *call, long double value)
{
    memcpy(call->long_result, &value, sizeof value);
    call->gives_long = 1;
    return 0;
}

/* ---- a native for each kind of function --------------------------------------------------------------------------- */

#define LEAVE(call, type) (sizeof(type) > sizeof(double) ? modes_leave_long(call) : modes_leave(call))
#define COMPUTES(type, give, expression)  \
    {                                     \
        modes_enter(call);                \
        type value = expression;          \
        LEAVE(call, type);                \
        return give(call, value);         \
    }
#define AS(result, ...) ((result (*)(__VA_ARGS__))self->target)
#define TELLS(result, type, expression)   \
    {                                     \
        modes_enter(call);                \
        result value = expression;        \
        LEAVE(call, type);                \
        return (uint64_t)(int64_t)value;  \
    }

#define KINDS(s, type)                                                                                                   \
    NATIVE(one##s) COMPUTES(type, give##s, AS(type, type)(take##s(call, 0)))                                             \
    NATIVE(two##s) COMPUTES(type, give##s, AS(type, type, type)(take##s(call, 0), take##s(call, 1)))                     \
    NATIVE(three##s)                                                                                                     \
    COMPUTES(type, give##s, AS(type, type, type, type)(take##s(call, 0), take##s(call, 1), take##s(call, 2)))            \
    NATIVE(with_int##s) COMPUTES(type, give##s, AS(type, type, int)(take##s(call, 0), (int)WORD(0)))                     \
    NATIVE(with_long##s) COMPUTES(type, give##s, AS(type, type, long)(take##s(call, 0), (long)WORD(0)))                  \
    NATIVE(behind_int##s) COMPUTES(type, give##s, AS(type, int, type)((int)WORD(0), take##s(call, 0)))                   \
    NATIVE(with_output##s) COMPUTES(type, give##s, AS(type, type, void *)(take##s(call, 0), POINTER(0)))                 \
    NATIVE(two_with_output##s)                                                                                           \
    COMPUTES(type, give##s, AS(type, type, type, void *)(take##s(call, 0), take##s(call, 1), POINTER(0)))                \
    NATIVE(of_text##s) COMPUTES(type, give##s, AS(type, const char *)((const char *)POINTER(0)))                         \
    NATIVE(to_int##s) TELLS(int, type, AS(int, type)(take##s(call, 0)))                                               \
    NATIVE(to_long##s) TELLS(long, type, AS(long, type)(take##s(call, 0)))                                            \
    NATIVE(signed_gamma##s) COMPUTES(type, give##s, lgamma##s##_r(take##s(call, 0), &STATE->signgam))                           \
    NATIVE(both##s)                                                                                                      \
    {                                                                                                                    \
        modes_enter(call);                                                                                               \
        sincos##s(take##s(call, 0), (type *)POINTER(0), (type *)POINTER(1));                                             \
        LEAVE(call, type);                                                                                               \
        return 0;                                                                                                        \
    }
KINDS(, double)
KINDS(f, float)
KINDS(l, long double)

#if defined(__x86_64__)
enum { SECOND_LONG = 0 };
#else
enum { SECOND_LONG = 1 };
#endif
NATIVE(toward) COMPUTES(double, give, nexttoward(take(call, 0), takel(call, SECOND_LONG)))
NATIVE(towardf) COMPUTES(float, givef, nexttowardf(takef(call, 0), takel(call, SECOND_LONG)))

#define ALL(name, kind) {#name, kind, (void *)name}, {#name "f", kind##f, (void *)name##f}, {#name "l", kind##l, (void *)name##l}
#define CLASSIFIES(name) \
    {#name, to_int, (void *)name}, {#name "f", to_intf, (void *)name##f}, {#name "l", to_intl, (void *)name##l}
#define STANDS_FOR(name, kind) {#name, kind, NULL}, {#name "f", kind##f, NULL}, {#name "l", kind##l, NULL}

/* What the macros of math.h lead to in C++, and with options such as -fsignaling-nans. */
extern int __fpclassify(double), __fpclassifyf(float), __fpclassifyl(long double);
extern int __signbit(double), __signbitf(float), __signbitl(long double);
extern int __isinf(double), __isinff(float), __isinfl(long double);
extern int __isnan(double), __isnanf(float), __isnanl(long double);
extern int __finite(double), __finitef(float), __finitel(long double);

HIDDEN const NativeRow natives_of_math[] = {
    ALL(acos, one), ALL(asin, one), ALL(atan, one), ALL(cos, one), ALL(sin, one), ALL(tan, one),
    ALL(acosh, one), ALL(asinh, one), ALL(atanh, one), ALL(cosh, one), ALL(sinh, one), ALL(tanh, one),
    ALL(exp, one), ALL(exp2, one), ALL(exp10, one), ALL(expm1, one),
    ALL(log, one), ALL(log2, one), ALL(log10, one), ALL(log1p, one), ALL(logb, one),
    ALL(sqrt, one), ALL(cbrt, one), ALL(fabs, one), ALL(erf, one), ALL(erfc, one), ALL(tgamma, one),
    ALL(ceil, one), ALL(floor, one), ALL(trunc, one), ALL(round, one), ALL(rint, one), ALL(nearbyint, one),
    ALL(j0, one), ALL(j1, one), ALL(y0, one), ALL(y1, one), ALL(significand, one),
    ALL(jn, behind_int), ALL(yn, behind_int),
    ALL(pow, two), ALL(atan2, two), ALL(hypot, two), ALL(fmod, two), ALL(remainder, two), ALL(drem, two),
    ALL(fmin, two), ALL(fmax, two), ALL(fdim, two), ALL(copysign, two), ALL(nextafter, two), ALL(scalb, two),
    ALL(fma, three),
    ALL(ldexp, with_int), ALL(scalbn, with_int), ALL(scalbln, with_long),
    ALL(frexp, with_output), ALL(modf, with_output), ALL(remquo, two_with_output),
    ALL(nan, of_text), ALL(ilogb, to_int),
    ALL(lround, to_long), ALL(lrint, to_long), ALL(llround, to_long), ALL(llrint, to_long),
    STANDS_FOR(lgamma, signed_gamma), STANDS_FOR(gamma, signed_gamma), STANDS_FOR(sincos, both),
    {"lgamma_r", with_output, (void *)lgamma_r},
    {"lgammaf_r", with_outputf, (void *)lgammaf_r},
    {"lgammal_r", with_outputl, (void *)lgammal_r},
    {"nexttoward", toward},
    {"nexttowardf", towardf},
    {"nexttowardl", twol, (void *)nextafterl},
    CLASSIFIES(__fpclassify), CLASSIFIES(__signbit), CLASSIFIES(__isinf), CLASSIFIES(__isnan), CLASSIFIES(__finite),
    {"isinf", to_int, (void *)__isinf}, {"isinff", to_intf, (void *)__isinff}, {"isinfl", to_intl, (void *)__isinfl},
    {"isnan", to_int, (void *)__isnan}, {"isnanf", to_intf, (void *)__isnanf}, {"isnanl", to_intl, (void *)__isnanl},
    {"finite", to_int, (void *)__finite}, {"finitef", to_intf, (void *)__finitef}, {"finitel", to_intl, (void *)__finitel},
    {NULL},
};
