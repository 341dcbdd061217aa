// What GoogleTest asks of the computer that a flight computer does not have: processes, pipes, a terminal. There are none,
// which is what these functions answer. A death test, which would start a process, fails.
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <cwchar>

#include <fcntl.h>
#include <netdb.h>
#include <regex.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace
{

template <class T = int>
T refused()
{
    return static_cast<T>(-1);
}

bool is_between(int c, int first, int last)
{
    return c >= first && c <= last;
}

} // namespace

extern "C" {

// -- processes, files, sockets -------------------------------------------------------------------------------------------

pid_t fork()
{
    return refused<pid_t>();
}
int clone(int (*)(void *), void *, int, void *, ...)
{
    return refused();
}
pid_t waitpid(pid_t, int *, int)
{
    return refused<pid_t>();
}
int execv(const char *, char *const[])
{
    return refused();
}
[[noreturn]] void _exit(int status)
{
    std::exit(status);
}
int pipe(int *)
{
    return refused();
}
int dup(int)
{
    return refused();
}
int dup2(int, int)
{
    return refused();
}
ssize_t read(int, void *, size_t)
{
    return refused<ssize_t>();
}
ssize_t write(int, const void *, size_t)
{
    return refused<ssize_t>();
}
int mkstemp(char *)
{
    return refused();
}
int remove(const char *)
{
    return refused();
}
int stat(const char *, struct stat *)
{
    return refused();
}
int chdir(const char *)
{
    return refused();
}
char *getcwd(char *to, size_t size)
{
    return size < 2 ? nullptr : std::strcpy(to, "/");
}
long ftell(FILE *)
{
    return refused<long>();
}
int fileno(FILE *)
{
    return 1;
}
int isatty(int)
{
    return 0;
}
int getpagesize()
{
    return 4096;
}
int munmap(void *, size_t)
{
    return refused();
}
int sigemptyset(sigset_t *)
{
    return 0;
}
int socket(int, int, int)
{
    return refused();
}
int connect(int, const struct sockaddr *, socklen_t)
{
    return refused();
}
int getaddrinfo(const char *, const char *, const struct addrinfo *, struct addrinfo **)
{
    return EAI_FAIL;
}
void freeaddrinfo(struct addrinfo *) {}
const char *gai_strerror(int)
{
    return "there are no sockets here";
}
struct tm *localtime_r(const time_t *, struct tm *)
{
    return nullptr; // a date of now would be another in each run
}

// -- regular expressions: none is one ------------------------------------------------------------------------------------

int regcomp(regex_t *, const char *, int)
{
    return REG_BADPAT;
}
int regexec(const regex_t *, const char *, size_t, regmatch_t *, int)
{
    return REG_NOMATCH;
}
void regfree(regex_t *) {}

// -- texts ---------------------------------------------------------------------------------------------------------------

int isalpha(int c)
{
    return is_between(c | 0x20, 'a', 'z');
}
int isalnum(int c)
{
    return is_between(c, '0', '9') || isalpha(c);
}
int isspace(int c)
{
    return c == ' ' || is_between(c, '\t', '\r');
}
int iscntrl(int c)
{
    return is_between(c, 0, 31) || c == 127;
}
int isxdigit(int c)
{
    return is_between(c, '0', '9') || is_between(c | 0x20, 'a', 'f');
}
char *strerror(int)
{
    static char text[] = "not on a flight computer";
    return text;
}
char *strdup(const char *text)
{
    char *made = static_cast<char *>(std::malloc(std::strlen(text) + 1));
    return made == nullptr ? nullptr : std::strcpy(made, text);
}
int wcscasecmp(const wchar_t *one, const wchar_t *other)
{
    const auto lower = [](wchar_t c) { return is_between(static_cast<int>(c), 'A', 'Z') ? c | 0x20 : c; };
    while (*one != 0 && lower(*one) == lower(*other))
    {
        ++one;
        ++other;
    }
    return static_cast<int>(lower(*one)) - static_cast<int>(lower(*other));
}

// The header has it as functions of C++ with this name in the object file.
const wchar_t *roscfe_wcsstr(const wchar_t *text, const wchar_t *part) __asm__("wcsstr");
const wchar_t *roscfe_wcsstr(const wchar_t *text, const wchar_t *part)
{
    for (;; ++text)
    {
        std::size_t same = 0;
        while (part[same] != 0 && text[same] == part[same])
        {
            ++same;
        }
        if (part[same] == 0)
        {
            return text;
        }
        if (*text == 0)
        {
            return nullptr;
        }
    }
}

} // extern "C"
