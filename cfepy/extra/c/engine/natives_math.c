/* libm: a row for each of its functions, in both precisions. */
#define _GNU_SOURCE
#include "engine.h"

#include <math.h>
#include <string.h>

static float low_half(double value)
{
    float half;
    memcpy(&half, &value, sizeof half);
    return half;
}

static uint64_t give(Coroutine *call, double value)
{
    call->float_result = value;
    return 0;
}

static uint64_t give_half(Coroutine *call, float value)
{
    memcpy(&call->float_result, &value, sizeof value);
    return 0;
}

NATIVE(one) { return give(call, ((double (*)(double))self->target)(call->floats[0])); }
NATIVE(two) { return give(call, ((double (*)(double, double))self->target)(call->floats[0], call->floats[1])); }
NATIVE(with_int) { return give(call, ((double (*)(double, int))self->target)(call->floats[0], (int)WORD(0))); }
NATIVE(with_output) { return give(call, ((double (*)(double, void *))self->target)(call->floats[0], POINTER(0))); }
NATIVE(to_long) { return (uint64_t)((long (*)(double))self->target)(call->floats[0]); }

NATIVE(one_half) { return give_half(call, ((float (*)(float))self->target)(low_half(call->floats[0]))); }
NATIVE(two_halves)
{
    float (*function)(float, float) = (float (*)(float, float))self->target;
    return give_half(call, function(low_half(call->floats[0]), low_half(call->floats[1])));
}
NATIVE(half_to_long) { return (uint64_t)((long (*)(float))self->target)(low_half(call->floats[0])); }

NATIVE(both)
{
    sincos(call->floats[0], (double *)POINTER(0), (double *)POINTER(1));
    return 0;
}

NATIVE(both_halves)
{
    sincosf(low_half(call->floats[0]), (float *)POINTER(0), (float *)POINTER(1));
    return 0;
}

#define ONE(name) {#name, one, (void *)(double (*)(double))name}, {#name "f", one_half, (void *)(float (*)(float))name##f}
#define TWO(name) \
    {#name, two, (void *)(double (*)(double, double))name}, {#name "f", two_halves, (void *)(float (*)(float, float))name##f}

HIDDEN const NativeRow natives_of_math[] = {
    ONE(sin),   ONE(cos),   ONE(tan),   ONE(asin),  ONE(acos),  ONE(atan),  ONE(sinh),  ONE(cosh),  ONE(tanh),
    ONE(asinh), ONE(acosh), ONE(atanh), ONE(exp),   ONE(exp2),  ONE(expm1), ONE(log),   ONE(log2),  ONE(log10),
    ONE(log1p), ONE(sqrt),  ONE(cbrt),  ONE(fabs),  ONE(ceil),  ONE(floor), ONE(trunc), ONE(round), ONE(rint),
    ONE(nearbyint), ONE(erf), ONE(erfc), ONE(tgamma), ONE(lgamma),
    TWO(pow),   TWO(atan2), TWO(hypot), TWO(fmod),  TWO(fmin),  TWO(fmax),  TWO(fdim),  TWO(copysign),
    TWO(remainder), TWO(nextafter),
    {"ldexp", with_int, (void *)(double (*)(double, int))ldexp},
    {"scalbn", with_int, (void *)(double (*)(double, int))scalbn},
    {"frexp", with_output, (void *)(double (*)(double, int *))frexp},
    {"modf", with_output, (void *)(double (*)(double, double *))modf},
    {"lround", to_long, (void *)(long (*)(double))lround},
    {"lrint", to_long, (void *)(long (*)(double))lrint},
    {"lroundf", half_to_long, (void *)(long (*)(float))lroundf},
    {"lrintf", half_to_long, (void *)(long (*)(float))lrintf},
    {"sincos", both},
    {"sincosf", both_halves},
    {NULL},
};
