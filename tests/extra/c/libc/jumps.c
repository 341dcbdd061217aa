/* setjmp() and longjmp(). */
#include "trial.h"

#include <setjmp.h>

static jmp_buf outer, inner;
static sigjmp_buf with_signals;
static volatile int depth;

static __attribute__((noinline)) int deep(int level, int value)
{
    volatile char used[200];
    memset((char *)used, level, sizeof used);
    depth = level;
    if (level == 0)
        longjmp(outer, value);
    return deep(level - 1, value) + used[level];
}

static __attribute__((noinline)) double with_registers(double a, double b, long c, long d, long e, long f)
{
    double sum = a * b;
    long more = c + d, even = e * f;
    volatile int rounds = 0;
    int got = setjmp(inner);
    if (got < 5) {
        rounds++;
        longjmp(inner, got + 1);
    }
    return sum + more + even + rounds;
}

static void trial(void)
{
    static const int values[] = {1, 0, -1, 5, INT_MAX, INT_MIN};
    EACH(const int, value, values) {
        volatile int kept = 17 + *value;
        int got = setjmp(outer);
        if (got == 0)
            deep(20, *value);
        SAY("%d: %d %d %d", *value, got, kept, depth);
    }
    SAY("%g", with_registers(1.5, 2.5, 3, 4, 5, 6));
    int got = sigsetjmp(with_signals, 1);
    if (got == 0)
        siglongjmp(with_signals, 9);
    SAY("%d", got);
    got = _setjmp(outer);
    if (got < 3)
        _longjmp(outer, got + 1);
    SAY("%d", got);
    jmp_buf copy;
    volatile int rounds = 0;
    got = setjmp(copy);
    memcpy(&inner, &copy, sizeof copy);
    if (rounds++ < 3)
        longjmp(inner, rounds);
    SAY("%d %d", got, rounds);
}
