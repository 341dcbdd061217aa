"""The functions of C and POSIX that compiled code must not call, because they bring in the host, and why not.

`cfepy check` and the report at load name them. A call is a fault with the same reason.
"""

from __future__ import annotations

_COMPLEX = (
    *("acos", "acosh", "arg", "asin", "asinh", "atan", "atanh", "cos", "cosh", "exp", "imag", "log", "pow", "proj"),
    *("real", "sin", "sinh", "sqrt", "tan", "tanh"),
)

BY_REASON: dict[str, tuple[str, ...]] = {
    "only files and folders of the mission are available; use fopen, open or OS_OpenCreate": (
        *(
            "chdir",
            "fchdir",
            "fmemopen",
            "link",
            "mkfifo",
            "mkstemp",
            "open_memstream",
            "readlink",
            "realpath",
            "shm_open",
            "statvfs",
            "symlink",
            "tmpfile",
            "tmpnam",
        ),
    ),
    "CPU time and the clock of the host are not available; use clock_gettime or OS_SetLocalTime": (
        *("clock", "clock_settime", "settimeofday", "times", "timespec_getres"),
    ),
    "a flight computer has no shell; see OS_ShellOutputToFile": ("popen", "pclose", "system"),
    "a flight computer has no processes; a task is made by OS_TaskCreate": (
        *("execl", "execlp", "execv", "execve", "execvp", "fork", "posix_spawn", "vfork", "wait", "waitpid"),
    ),
    "a process that ends is all of cFE; use CFE_ES_ExitApp": ("__cxa_at_quick_exit", "at_quick_exit"),
    "signals are those of the host's process; a fault is reported by cFE, and OS_TimerCreate calls at times": (
        *(
            "alarm",
            "kill",
            "pause",
            "raise",
            "setitimer",
            "sigfillset",
            "sigaddset",
            "sigprocmask",
            "sigwait",
            "timer_create",
            "timer_settime",
        ),
    ),
    "a task is made by OS_TaskCreate or CFE_ES_CreateChildTask, also in place of std::thread": (
        *("pthread_create", "pthread_detach", "pthread_exit", "pthread_join", "thrd_create", "thrd_current"),
        *("thrd_detach", "thrd_equal", "thrd_exit", "thrd_join", "thrd_sleep", "thrd_yield"),
    ),
    "a task waits for another by OS_BinSemTake, or by a pipe": (
        *("cnd_broadcast", "cnd_destroy", "cnd_init", "cnd_signal", "cnd_timedwait", "cnd_wait"),
        *("pthread_cond_broadcast", "pthread_cond_init", "pthread_cond_signal", "pthread_cond_timedwait"),
        *("pthread_cond_wait", "pthread_condattr_init", "sem_init", "sem_post", "sem_timedwait", "sem_wait"),
    ),
    "tasks lock by OS_MutSemTake": (
        *("call_once", "mtx_destroy", "mtx_init", "mtx_lock", "mtx_timedlock", "mtx_trylock", "mtx_unlock"),
    ),
    "a variable of a task is declared _Thread_local": ("tss_create", "tss_delete", "tss_get", "tss_set"),
    "the mission's network has one host, localhost; use socket, gethostbyname or OS_SocketOpen": (
        *("getifaddrs", "gethostbyaddr", "gethostname", "getnameinfo", "getservbyname", "if_nameindex", "socketpair"),
    ),
    "descriptors are waited for by select or poll": (
        *("epoll_create", "epoll_create1", "epoll_ctl", "epoll_wait", "eventfd", "timerfd_create"),
    ),
    "random numbers of the host differ in each run; use rand() with a seed": (
        *("arc4random", "arc4random_buf", "arc4random_uniform", "getentropy", "getrandom"),
    ),
    "the environment of the host is not available": ("clearenv", "putenv", "setenv", "unsetenv"),
    "streams have no wide characters; use printf with %ls": (
        *("fgetwc", "fgetws", "fputwc", "fputws", "fwide", "fwprintf", "fwscanf", "getwchar", "putwc", "putwchar"),
        *("ungetwc", "vfwprintf", "vfwscanf", "vwprintf", "vwscanf", "wcsftime", "wprintf", "wscanf"),
    ),
    "the only language is C's": (
        *("bind_textdomain_codeset", "bindtextdomain", "dgettext", "iconv", "iconv_close", "iconv_open"),
        *("__strftime_l", "__wcscoll_l", "__wcsftime_l", "__wcsxfrm_l", "mbsnrtowcs", "wcsnrtombs"),
    ),
    "texts in UTF-16 and UTF-32 are not available; the locale C has single bytes": (
        *("c16rtomb", "c32rtomb", "mbrtoc16", "mbrtoc32"),
    ),
    "complex numbers are not available; compute with their two parts": (
        *(f"c{name}{precision}" for name in _COMPLEX for precision in ("", "f", "l")),
        *(f"{name}{precision}" for name in ("cabs", "conj") for precision in ("", "f", "l")),
    ),
}

REASONS: dict[str, str] = {name: reason for reason, names in BY_REASON.items() for name in names}
"""By name."""


def refusal_of(name: str) -> str | None:
    """Return why compiled code must not call a function; None if it may."""
    return REASONS.get(name)
