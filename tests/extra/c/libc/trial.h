/* What the programs of these tests have in common. Each has a trial(), which prints what functions of libc answer: as a
 * program of this computer, and as an application of cfepy. Both must print the same.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SAY(...) printf("> " __VA_ARGS__), printf("\n")
#define COUNT(array) (sizeof(array) / sizeof *(array))
#define EACH(type, name, array) for (type *name = (array); name < (array) + COUNT(array); name++)

static uint64_t random_state = 88172645463325252u;

/* A number below a limit, the same in each run. */
static inline uint32_t any(uint32_t limit)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (uint32_t)(random_state >> 32) % limit;
}

/* A text made of pieces that are chosen from a list. */
static inline const char *any_text(const char *const *pieces, size_t count, int most)
{
    static char text[400];
    text[0] = 0;
    for (int left = (int)any((uint32_t)most + 1); left > 0; left--)
        strncat(text, pieces[any((uint32_t)count)], sizeof text - strlen(text) - 1);
    return text;
}

/* A text as a literal of C has it. */
static inline const char *quoted(const char *text)
{
    static char rooms[4][2000];
    static int next;
    char *room = rooms[next++ % 4], *to = room;
    if (text == NULL)
        return "NULL";
    for (*to++ = '"'; *text && to < room + sizeof rooms[0] - 8; text++)
        to += *text < ' ' || *text > '~' || *text == '"' || *text == '\\' ? sprintf(to, "\\%03o", (unsigned char)*text) : (*to = *text, 1);
    strcpy(to, "\"");
    return room;
}

static void trial(void);
void TEST_Main(void) { trial(); }
