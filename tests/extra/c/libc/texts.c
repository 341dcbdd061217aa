/* <string.h>, <ctype.h>, errors, malloc. */
#include "trial.h"

#include <ctype.h>
#include <locale.h>
#include <strings.h>

static const char *const texts[] = {
    "", "a", "b", "A", "ab", "abc", "abcabc", "ABC", "xabcy", ",", "a,b,,c", "  words in  a row ", "\xe9t\xe9", "\xc3\xa9", "zzzzzzzzzzzzzzzzzzzzzzzz",
    "zzzzzzzzzzzzzzzzzzzzzzzy", "0123456789", "aXbXc", "\t\n",
};

#define OFFSET(found, in) ((found) == NULL ? -1L : (long)((const char *)(found) - (const char *)(in)))
#define SIGN(value) (((value) > 0) - ((value) < 0))
#define FILLED(room) memset(room, '#', sizeof room), room[sizeof room - 1] = 0

static int compare(const void *a, const void *b) { return *(const int *)a - *(const int *)b; }
static int compare_by(const void *a, const void *b, void *sign) { return (*(const int *)a - *(const int *)b) * *(int *)sign; }

static void pair(const char *a, const char *b)
{
    SAY("compare %s %s: %d %d %d %d", quoted(a), quoted(b), SIGN(strcmp(a, b)), SIGN(strcasecmp(a, b)), SIGN(strcoll(a, b)), SIGN(memcmp(a, b, strlen(a) < strlen(b) ? strlen(a) : strlen(b))));
    SAY("find %ld %ld %ld %zu %zu %ld", OFFSET(strstr(a, b), a), OFFSET(strcasestr(a, b), a), OFFSET(strpbrk(a, b), a), strspn(a, b), strcspn(a, b), OFFSET(memmem(a, strlen(a), b, strlen(b)), a));
    for (size_t most = 0; most < 5; most++) {
        char room[60], other[60];
        FILLED(room);
        strncpy(room, a, most);
        FILLED(other);
        char *end = stpncpy(other, a, most);
        SAY("limited %zu: %d %d %s %ld %s", most, SIGN(strncmp(a, b, most)), SIGN(strncasecmp(a, b, most)), quoted(room), OFFSET(end, other), quoted(other));
        strcpy(room, a);
        strncat(room, b, most);
        size_t size = strxfrm(other, a, most);
        SAY("%s %zu %zu", quoted(room), size, strnlen(a, most));
    }
    char room[100], *end = stpcpy(room, a);
    strcat(room, b);
    SAY("%s %ld", quoted(room), OFFSET(end, room));
    char split[100], *place = NULL;
    strcpy(split, a);
    for (char *part = strtok(split, b); part != NULL; part = strtok(NULL, b))
        SAY("strtok %s", quoted(part));
    strcpy(split, a);
    for (char *part = strtok_r(split, b, &place); part != NULL; part = strtok_r(NULL, b, &place))
        SAY("strtok_r %s %ld", quoted(part), OFFSET(place, split));
    strcpy(split, a);
    for (char *rest = split, *part; (part = strsep(&rest, b)) != NULL;)
        SAY("strsep %s", quoted(part));
}

static void one(const char *text)
{
    for (const char *which = "abX\xe9" ",z"; *which; which++)
        SAY("%s %c: %ld %ld %ld %ld %ld %ld %ld", quoted(text), *which & 0x7F, OFFSET(strchr(text, *which), text), OFFSET(strrchr(text, *which), text), OFFSET(strchrnul(text, *which), text),
            OFFSET(memchr(text, *which, strlen(text)), text), OFFSET(memrchr(text, *which, strlen(text)), text), OFFSET(index(text, *which), text), OFFSET(rindex(text, *which), text));
    char *copy = strdup(text), *part = strndup(text, 3);
    SAY("%s %s %zu", quoted(copy), quoted(part), strlen(text));
    free(copy);
    free(part);
    char room[60];
    FILLED(room);
    SAY("%ld", OFFSET(mempcpy(room, text, strlen(text)), room));
    SAY("%ld %s", OFFSET(memccpy(room, text, 'b', strlen(text)), room), quoted(room));
    FILLED(room);
    memmove(room + 3, memset(room, 'q', 5), 20);
    bcopy(room, room + 2, 4);
    bzero(room + 8, 1);
    SAY("%s %d", quoted(room), bcmp(room, text, 1) != 0);
}

static void characters(void)
{
    for (int c = -128; c < 256; c++)
        SAY("%d: %d%d%d%d%d%d%d%d%d%d%d%d %d %d %d%d%d%d%d %d %d", c, !!(isalnum)(c), !!(isalpha)(c), !!(isblank)(c), !!(iscntrl)(c), !!(isdigit)(c), !!(isgraph)(c), !!(islower)(c), !!(isprint)(c),
            !!(ispunct)(c), !!(isspace)(c), !!(isupper)(c), !!(isxdigit)(c), (toupper)(c), (tolower)(c), !!isalnum(c), !!isalpha(c), !!isspace(c), !!isprint(c), !!isxdigit(c), isascii(c), toascii(c));
}

static void errors(void)
{
    static const int more[] = {-1, 134, 200, INT_MAX, INT_MIN};
    for (int i = -1; i < 140; i++) {
        int number = i < 134 ? i : more[(i - 134) % COUNT(more)];
        char room[50], other[50];
        FILLED(room);
        FILLED(other);
        int status = __xpg_strerror_r(number, room, sizeof room);
        int short_status = __xpg_strerror_r(number, other, 8);
        char third[60] = "";
        SAY("%d: %s %d %s %d %s %s", number, strerror(number), status, room, short_status, other, strerror_r(number, third, 12));
    }
    SAY("%s", setlocale(LC_ALL, NULL));
    SAY("%d %d", setlocale(LC_ALL, "none_NONE") == NULL, setlocale(LC_ALL, "C") != NULL);
    struct lconv *found = localeconv();
    SAY("%s %s %s %s %d %d %d", quoted(found->decimal_point), quoted(found->thousands_sep), quoted(found->grouping), quoted(found->mon_decimal_point), found->frac_digits, found->int_p_sign_posn, found->p_cs_precedes);
}

static void blocks(void)
{
    errno = 0;
    void *none = malloc(SIZE_MAX / 2);
    SAY("%d %d", none == NULL, errno);
    errno = 0;
    none = calloc(SIZE_MAX / 2, 4);
    SAY("%d %d", none == NULL, errno);
    errno = 0;
    none = reallocarray(NULL, SIZE_MAX / 2, 4);
    SAY("%d %d", none == NULL, errno);
    SAY("%d", realloc(malloc(10), 0) == NULL);
    void *aligned = NULL;
    static const size_t alignments[] = {0, 1, 3, 4, 8, 16, 64, 4096};
    EACH(const size_t, alignment, alignments) {
        aligned = NULL;
        int status = posix_memalign(&aligned, *alignment, 100);
        SAY("%zu: %d %d", *alignment, status, aligned != NULL && (uintptr_t)aligned % *alignment == 0);
        free(aligned);
    }
    aligned = aligned_alloc(256, 512);
    SAY("%d", (int)((uintptr_t)aligned % 256));
    free(aligned);
    char *block = malloc(3);
    strcpy(block, "ab");
    block = realloc(block, 5000);
    SAY("%s", block);
    block = reallocarray(block, 3, 3);
    SAY("%s", block);
    free(block);
    int numbers[] = {5, 3, 9, 1, 7, 2, 8}, sign = -1, key = 7, missing = 4;
    qsort(numbers, COUNT(numbers), sizeof *numbers, compare);
    SAY("%d %d %d %d %d %d %d", numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6]);
    SAY("%ld %d", (long)((int *)bsearch(&key, numbers, COUNT(numbers), sizeof *numbers, compare) - numbers), bsearch(&missing, numbers, COUNT(numbers), sizeof *numbers, compare) == NULL);
    qsort_r(numbers, COUNT(numbers), sizeof *numbers, compare_by, &sign);
    SAY("%d %d %d %d %d %d %d", numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6]);
    for (int bit = 0; bit < 64; bit++)
        SAY("%d %d %d", ffs((int)(1ull << bit)), ffsl((long)(3ull << bit)), ffsll(5ll << bit));
}

static void trial(void)
{
    EACH(const char *const, a, texts) {
        one(*a);
        EACH(const char *const, b, texts)
            if (**b != 0 || **a == 0)
                pair(*a, *b);
    }
    characters();
    errors();
    blocks();
    static const char *const pieces[] = {"a", "b", "c", ",", " ", "ab", "xyz"};
    for (int i = 0; i < 200; i++) {
        char first[400];
        strcpy(first, any_text(pieces, COUNT(pieces), 9));
        const char *second = any_text(pieces, COUNT(pieces), 3);
        if (*second && strlen(first) < 40)
            pair(first, second);
    }
}
