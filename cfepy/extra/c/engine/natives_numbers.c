/* Numbers of libc, without libm: out of texts, quotients, and rand(). */
#define _GNU_SOURCE
#include "natives.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* ---- out of texts ------------------------------------------------------------------------------------------------- */

/* C23 knows binary numbers: 0b101. Code that was compiled with headers of glibc 2.38 and later calls these functions. */
static const char *digits_of_binary(const char *text, int base, bool *is_negative)
{
    while (strchr(" \t\n\v\f\r", *text) != NULL && *text != 0)
        text++;
    *is_negative = *text == '-';
    if (*text == '-' || *text == '+')
        text++;
    bool has_prefix = (base == 0 || base == 2) && text[0] == '0' && (text[1] | 32) == 'b' && (text[2] | 1) == '1';
    return has_prefix ? text + 2 : NULL;
}

static long long_with_binary(const char *text, char **end, int base)
{
    bool is_negative;
    const char *digits = digits_of_binary(text, base, &is_negative);
    if (digits == NULL)
        return strtol(text, end, base);
    char sized[80]; /* a sign, and digits enough to be out of range */
    size_t zeros = strspn(digits, "0"), count = strspn(digits + zeros, "01");
    if (end != NULL)
        *end = (char *)digits + zeros + count;
    size_t kept = count < sizeof sized - 2 ? count : sizeof sized - 2;
    sized[0] = is_negative ? '-' : '+';
    memcpy(sized + 1, digits + zeros, kept);
    memcpy(sized + 1 + kept, kept ? "" : "0", kept ? 1 : 2);
    return strtol(sized, NULL, 2);
}

static unsigned long unsigned_with_binary(const char *text, char **end, int base)
{
    bool is_negative;
    const char *digits = digits_of_binary(text, base, &is_negative);
    if (digits == NULL)
        return strtoul(text, end, base);
    unsigned long value = strtoul(digits, end, 2);
    return is_negative && errno != ERANGE ? -value : value;
}

static size_t of_number(const char *text, int base)
{
    char *end;
    strtol(text, &end, base);
    return (size_t)(end - text) + 1;
}

typedef long (*Parser)(const char *, char **, int);

static uint64_t parsed(Coroutine *call, Parser parser, char **end, int base)
{
    if (call->table->races != NULL) {
        const Range ranges[] = {READS(TEXT(0), of_number(TEXT(0), base)), WRITES(end, end == NULL ? 0 : sizeof *end)};
        if (waits_for_others(call, ranges, 2))
            return 0;
    }
    libc_enter(call);
    uint64_t value = (uint64_t)parser(TEXT(0), end, base);
    libc_leave(call);
    return value;
}

NATIVE(integer_of_text) { return parsed(call, (Parser)self->target, (char **)POINTER(1), (int)WORD(2)); }
NATIVE(int_of_text) { return (uint64_t)(int64_t)(int)parsed(call, strtol, NULL, 10); }
NATIVE(long_of_text) { return parsed(call, strtol, NULL, 10); }

NATIVE(double_of_text)
{
    libc_enter_to_compute(call);
    call->float_result = strtod(TEXT(0), self->target != NULL ? NULL : (char **)POINTER(1));
    libc_leave(call);
    return 0;
}

NATIVE(float_of_text)
{
    libc_enter_to_compute(call);
    float value = strtof(TEXT(0), (char **)POINTER(1));
    libc_leave(call);
    memcpy(&call->float_result, &value, sizeof value);
    return 0;
}

NATIVE(long_double_of_text)
{
    libc_enter_to_compute(call);
    long double value = strtold(TEXT(0), (char **)POINTER(1));
    libc_leave(call);
    memcpy(call->long_result, &value, sizeof value);
    call->gives_long = 1;
    return 0;
}

/* ---- quotients ---------------------------------------------------------------------------------------------------- */

NATIVE(absolute) { return (uint64_t)(int64_t)abs((int)WORD(0)); }
NATIVE(absolute_long) { return (uint64_t)labs((long)WORD(0)); }

NATIVE(divided)
{
    div_t made = div((int)WORD(0), (int)WORD(1));
    return (uint32_t)made.quot | (uint64_t)(uint32_t)made.rem << 32;
}

NATIVE(divided_long)
{
    ldiv_t made = ldiv((long)WORD(0), (long)WORD(1));
    call->result_high = (uint64_t)made.rem;
    return (uint64_t)made.quot;
}

/* In the byte order of networks: what <arpa/inet.h> has as functions, besides macros. */
NATIVE(word_of_network) { return __builtin_bswap32((uint32_t)WORD(0)); }
NATIVE(half_of_network) { return __builtin_bswap16((uint16_t)WORD(0)); }

/* ---- rand() ------------------------------------------------------------------------------------------------------- */

enum { STEPS = 31, APART = 3, WARM_UP = 310 };

/* Each number is the sum of those 31 and 3 before it; its lowest bit, which is the least random, is not given. */
static uint32_t next_random(Table *table)
{
    uint32_t at = table->random_at, *front = &table->random[(at + APART) % STEPS];
    *front += table->random[at];
    table->random_at = (at + 1) % STEPS;
    return *front >> 1;
}

HIDDEN void random_begin(Table *table, uint32_t seed)
{
    int64_t word = (int32_t)(seed ? seed : 1);
    for (int i = 0; i < STEPS; i++) {
        table->random[i] = (uint32_t)word;
        word = 16807 * word % 2147483647;
        if (word < 0)
            word += 2147483647;
    }
    table->random_at = 0;
    for (int i = 0; i < WARM_UP; i++)
        next_random(table);
}

NATIVE(any_number) { return next_random(call->table); }

NATIVE(seed)
{
    random_begin(call->table, (uint32_t)WORD(0));
    return 0;
}

/* 31 bits out of three steps of a generator of 32: 11, 10 and 10. */
NATIVE(any_number_of_seed)
{
    uint32_t *seed = (uint32_t *)POINTER(0), next = *seed, value = 0;
    for (int step = 0; step < 3; step++) {
        next = next * 1103515245 + 12345;
        value = value << 10 | (next >> 16 & (step == 0 ? 2047 : 1023));
    }
    *seed = next;
    return value;
}

static const char is_whole; /* marks atof, which tells of no end */

HIDDEN const NativeRow natives_of_numbers[] = {
    {"atoi", int_of_text},
    {"atol", long_of_text},
    {"atoll", long_of_text},
    {"strtol", integer_of_text, (void *)strtol},
    {"strtoll", integer_of_text, (void *)strtol},
    {"strtoimax", integer_of_text, (void *)strtol},
    {"strtoq", integer_of_text, (void *)strtol},
    {"strtoul", integer_of_text, (void *)strtoul},
    {"strtoull", integer_of_text, (void *)strtoul},
    {"strtoumax", integer_of_text, (void *)strtoul},
    {"strtouq", integer_of_text, (void *)strtoul},
    {"__isoc23_strtol", integer_of_text, (void *)long_with_binary},
    {"__isoc23_strtoll", integer_of_text, (void *)long_with_binary},
    {"__isoc23_strtoimax", integer_of_text, (void *)long_with_binary},
    {"__isoc23_strtoul", integer_of_text, (void *)unsigned_with_binary},
    {"__isoc23_strtoull", integer_of_text, (void *)unsigned_with_binary},
    {"__isoc23_strtoumax", integer_of_text, (void *)unsigned_with_binary},
    {"atof", double_of_text, (void *)&is_whole},
    {"strtod", double_of_text},
    {"strtof", float_of_text},
    {"strtold", long_double_of_text},
    {"abs", absolute},
    {"labs", absolute_long},
    {"llabs", absolute_long},
    {"imaxabs", absolute_long},
    {"div", divided},
    {"ldiv", divided_long},
    {"lldiv", divided_long},
    {"imaxdiv", divided_long},
    {"htonl", word_of_network},
    {"ntohl", word_of_network},
    {"htons", half_of_network},
    {"ntohs", half_of_network},
    {"rand", any_number},
    {"random", any_number},
    {"srand", seed},
    {"srandom", seed},
    {"rand_r", any_number_of_seed},
    {NULL},
};
