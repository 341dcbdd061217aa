"""One thread for the linear algebra of NumPy, so that its results are the same in each run.

The libraries below NumPy (OpenBLAS, MKL, BLIS) and OpenMP split a product or a solution among as many threads as the
process has CPUs. The order of additions, and with it the last digits, follows their number. It differs between
computers, and also between the kinds of tasks, because the threads of a run are pinned to one CPU.

These libraries read their number of threads from the environment when they are loaded. For a library that is loaded
already, cfepy calls the library's own function.
"""

from __future__ import annotations

import functools
import re
import sys

from cfepy.interpreter.host_system import ask_for_one_blas_thread

NUMPY = "numpy"
MAPS = "/proc/self/maps"  # on Linux; has the files that are loaded
_LIBRARIES = re.compile(r"/[^/]*(openblas|mkl_rt|blis|gomp|libomp|libiomp)[^/]*\.so[^/]*$")
_SETTERS = (
    "scipy_openblas_set_num_threads64_",
    "scipy_openblas_set_num_threads",
    "openblas_set_num_threads64_",
    "openblas_set_num_threads",
    "MKL_Set_Num_Threads",
    "bli_thread_set_num_threads",
    "omp_set_num_threads",
)


@functools.cache
def use_one_blas_thread() -> str:
    """Let linear algebra in this process use one thread, also if NumPy was imported before.

    Returns:
        Why that is not certain; empty if it is.
    """
    ask_for_one_blas_thread()
    if NUMPY not in sys.modules or _limit_loaded(_loaded_libraries()) or _limit_by_threadpoolctl():
        return ""
    return (
        f"{NUMPY} was imported before the run, and its linear algebra may use several threads; set "
        "OPENBLAS_NUM_THREADS=1, or install threadpoolctl"
    )


def _loaded_libraries() -> list[str]:
    """Return the loaded libraries that compute with threads."""
    try:
        with open(MAPS, encoding="utf-8", errors="replace") as maps:
            files = dict.fromkeys(line.split(None, 5)[-1].strip() for line in maps if "/" in line)
    except OSError:
        return []
    return [file for file in files if _LIBRARIES.search(file)]


def _limit_loaded(files: list[str]) -> bool:
    """Limit loaded libraries to one thread; return whether there were some, and all of them could be limited."""
    import ctypes

    limited = 0
    for file in files:
        try:
            library = ctypes.CDLL(file)
        except OSError:
            continue
        setters = [name for name in _SETTERS if hasattr(library, name)]
        for name in setters[:1]:
            getattr(library, name)(1)
            limited += 1
    return 0 < limited == len(files)


def _limit_by_threadpoolctl() -> bool:
    """Limit loaded libraries with the package threadpoolctl, if it is installed; return whether it knew one."""
    try:
        import threadpoolctl  # type: ignore[import-not-found, unused-ignore]
    except ImportError:
        return False
    threadpoolctl.threadpool_limits(1)
    found = threadpoolctl.threadpool_info()
    return bool(found) and all(each["num_threads"] == 1 for each in found)
