/* Pipes, SIGPIPE that is ignored, memory of mmap, and freopen. */
#include "trial.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#define TRY(call)                                                             \
    do {                                                                      \
        errno = 0;                                                            \
        long answer = (long)(call);                                           \
        SAY("%s = %ld, %d", #call, answer, answer == -1 ? errno : 0); \
    } while (0)

static char room[200000];

static void events_of(const char *when, int reader, int writer)
{
    struct pollfd both[] = {{reader, POLLIN | POLLOUT, 0}, {writer, POLLIN | POLLOUT, 0}};
    int count = poll(both, 2, 0);
    SAY("%s: poll %d, %x %x", when, count, both[0].revents, both[1].revents);
}

static void pipes(void)
{
    int ends[2], waiting = -1;
    struct stat about;
    TRY(pipe(ends));
    SAY("adjacent %d", ends[1] - ends[0]);
    events_of("empty", ends[0], ends[1]);
    TRY(write(ends[1], "abcdef", 6));
    TRY(write(ends[1], "", 0));
    events_of("six", ends[0], ends[1]);
    TRY(ioctl(ends[0], FIONREAD, &waiting));
    SAY("waiting %d", waiting);
    memset(room, 0, 20);
    TRY(read(ends[0], room, 4));
    SAY("read %s", room);
    TRY(write(ends[1], "ghi", 3));
    memset(room, 0, 20);
    TRY(read(ends[0], room, 100));
    SAY("read %s", room);
    TRY(read(ends[0], room, 0));
    TRY(read(ends[1], room, 1));
    TRY(write(ends[0], "x", 1));
    TRY(lseek(ends[0], 0, SEEK_CUR));
    TRY(pread(ends[0], room, 1, 0));
    TRY(fstat(ends[0], &about));
    SAY("fifo %d", S_ISFIFO(about.st_mode));
    SAY("flags %o %o", fcntl(ends[0], F_GETFL) & O_ACCMODE, fcntl(ends[1], F_GETFL) & O_ACCMODE);
    TRY(close(ends[1]));
    events_of("no writer", ends[0], -1);
    TRY(read(ends[0], room, 5));
    TRY(close(ends[0]));
    TRY(pipe2(ends, 077));
}

static void fill(int size)
{
    int ends[2];
    long total = 0, count, writes = 0;
    TRY(pipe2(ends, O_NONBLOCK));
    TRY(read(ends[0], room, 1));
    for (int i = 0; i < (int)sizeof room; i++)
        room[i] = (char)(i * 7 + i / 256);
    while ((count = write(ends[1], room, size)) > 0)
    {
        total += count;
        writes++;
    }
    SAY("full of %d: %ld bytes in %ld writes, errno %d", size, total, writes, errno);
    events_of("full", ends[0], ends[1]);
    SAY("read %zd", read(ends[0], room, 1000));
    SAY("write %zd errno %d", write(ends[1], room, 10), errno);
    SAY("read %zd", read(ends[0], room, 3096));
    SAY("write %zd errno %d", write(ends[1], room, 10), errno);
    unsigned sum = 0;
    total = 0;
    while ((count = read(ends[0], room, 7001)) > 0)
    {
        total += count;
        for (long i = 0; i < count; i++)
            sum = sum * 31 + (unsigned char)room[i];
    }
    SAY("rest %ld, %x, errno %d", total, sum, errno);
    close(ends[0]);
    errno = 0;
    SAY("no reader: %zd errno %d", write(ends[1], "x", 1), errno);
    events_of("no reader", -1, ends[1]);
    close(ends[1]);
}

static void signals(void)
{
    struct sigaction now = {0}, before;
    signal(SIGPIPE, SIG_DFL);
    SAY("signal %d", signal(SIGPIPE, SIG_IGN) == SIG_DFL);
    SAY("again %d", signal(SIGPIPE, SIG_IGN) == SIG_IGN);
    TRY(sigaction(SIGPIPE, NULL, &before));
    SAY("handler %d", before.sa_handler == SIG_IGN);
    now.sa_handler = SIG_DFL;
    sigemptyset(&now.sa_mask);
    TRY(sigaction(SIGPIPE, &now, &before));
    now.sa_handler = SIG_IGN;
    TRY(sigaction(SIGPIPE, &now, &before));
    SAY("handler %d", before.sa_handler == SIG_DFL);
    TRY(sigaction(SIGKILL, &now, NULL));
    TRY(sigaction(500, &now, NULL));
    SAY("bad %d %d", signal(0, SIG_IGN) == SIG_ERR, errno);
}

static void anonymous(void)
{
    long page = sysconf(_SC_PAGESIZE);
    SAY("page %d ticks %ld size %d", page == getpagesize(), sysconf(_SC_CLK_TCK), (int)page);
    TRY(sysconf(9999));
    unsigned char *made = mmap(NULL, 3 * page + 5, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    SAY("made %d aligned %d", made != MAP_FAILED, (int)((uintptr_t)made % page));
    unsigned sum = 0;
    for (long i = 0; i < 4 * page; i++)
        sum += made[i];
    SAY("zeros %u", sum);
    memset(made, 7, 4 * page);
    SAY("last %d", made[4 * page - 1]);
    TRY(munmap(made + 1, page));
    TRY(munmap(made, 0));
    TRY(munmap(made, 3 * page + 5));
    TRY(munmap(made, page));
    TRY(mmap(NULL, 0, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    TRY(mmap(NULL, page, PROT_READ, MAP_ANONYMOUS, -1, 0));
    TRY(mmap(NULL, page, PROT_READ, MAP_PRIVATE, -1, 0));
    TRY(mmap(NULL, page, PROT_READ, MAP_PRIVATE, 0, 1));
}

static void show(const char *path)
{
    char text[40] = "";
    FILE *file = fopen(path, "r");
    size_t count = fread(text, 1, 30, file);
    SAY("%s has %zu: %s", path, count, text);
    fclose(file);
}

static void files(void)
{
    long page = sysconf(_SC_PAGESIZE);
    FILE *file = fopen("cf/map.txt", "w");
    fputs("0123456789", file);
    fclose(file);
    int both = open("cf/map.txt", O_RDWR), reader = open("cf/map.txt", O_RDONLY), writer = open("cf/map.txt", O_WRONLY);
    TRY(mmap(NULL, 10, PROT_READ | PROT_WRITE, MAP_SHARED, reader, 0) == MAP_FAILED);
    SAY("errno %d", errno);
    TRY(mmap(NULL, 10, PROT_READ, MAP_SHARED, writer, 0) == MAP_FAILED);
    SAY("errno %d", errno);
    char *own = mmap(NULL, 10, PROT_READ | PROT_WRITE, MAP_PRIVATE, reader, 0);
    char *shared = mmap(NULL, 10, PROT_READ | PROT_WRITE, MAP_SHARED, both, 0);
    const char *fixed = mmap(NULL, 10, PROT_READ, MAP_SHARED, reader, 0);
    SAY("%.10s %.10s %.10s, behind %d", own, shared, fixed, shared[page - 1]);
    own[0] = 'x';
    shared[1] = 'y';
    TRY(msync(shared, 10, MS_SYNC));
    show("cf/map.txt");
    shared[2] = 'z';
    shared[12] = 'w';
    TRY(close(both));
    TRY(munmap(shared, 10));
    show("cf/map.txt");
    TRY(munmap(own, 10));
    TRY(munmap((void *)fixed, 10));
    TRY(msync(shared, 10, MS_SYNC));
    close(reader);
    close(writer);
    TRY(mmap(NULL, page, PROT_READ, MAP_PRIVATE, reader, 0) == MAP_FAILED);
}

static void reopened(void)
{
    char text[40] = "";
    FILE *file = fopen("cf/one.txt", "w");
    int number = fileno(file);
    fputs("first", file);
    FILE *again = freopen("cf/two.txt", "w+", file);
    SAY("same %d %d", again == file, fileno(again) == number);
    fputs("second", again);
    rewind(again);
    fgets(text, sizeof text, again);
    SAY("text %s, end %d", text, feof(again) != 0);
    again = freopen("cf/one.txt", "r", again);
    SAY("end %d error %d", feof(again) != 0, ferror(again) != 0);
    fgets(text, sizeof text, again);
    SAY("text %s", text);
    errno = 0;
    again = freopen("cf/gone/x", "r", again);
    SAY("gone %d %d", again == NULL, errno);
    show("cf/one.txt");
    show("cf/two.txt");
    SAY("free %d", dup(number) == -1);
}

static void trial(void)
{
    pipes();
    signals();
    int sizes[] = {1, 10, 100, 1000, 3000, 4096, 5000, 70000};
    EACH(int, size, sizes)
        fill(*size);
    anonymous();
    files();
    reopened();
}
