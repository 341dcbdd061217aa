"""Applications in C++: static objects, exceptions, the standard library, with and without libstdc++."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.c.linking import host_library
from cfepy.pilot.mission_check import check_mission
from tests.extra.c.building import (
    compile_cpp,
    console_of,
    digest_of,
    fly,
    make_safe,
    needs_compiler,
    needs_cpp,
    said,
    write_mission,
)

pytestmark = [needs_compiler, needs_cpp]

STATIC = ("-static-libstdc++", "-static-libgcc")
FREE = ("-fno-exceptions", "-fno-rtti", "-nostdlib", "-lgcc")
LINKS = {"shared": (), "static": STATIC}


def fly_cpp(folder: Path, source: str, *flags: str, seconds: float = 2, tasks: str = "thread") -> str:
    compile_cpp(folder, "TEST", source, *flags)
    return console_of(fly(write_mission(folder, "TEST"), seconds, tasks))


LIBRARY = """
    #include <functional>
    #include <map>
    #include <memory>
    #include <sstream>
    #include <stdexcept>
    #include <string>
    #include <vector>

    struct Shape { virtual ~Shape() {} virtual int corners() const = 0; };
    struct Square : Shape { int corners() const override { return 4; } };
    static std::vector<std::string> all{"one", "two", "a text that is too long to be inside the object itself"};

    extern "C" void TEST_Main()
    {
        std::unique_ptr<Shape> shape(new Square);
        std::function<int(int)> add = [&](int value) { return value + shape->corners(); };
        std::map<std::string, int> found;
        for (auto &each : all)
            found[each] = static_cast<int>(each.size());
        std::ostringstream text;
        for (auto &each : found)
            text << each.first.substr(0, 3) << "=" << each.second << " ";
        SAY("%s%d %.2f", text.str().c_str(), add(38), std::stod("2.5"));
        try {
            OS_TaskDelay(10);
            all.at(7);
        } catch (const std::out_of_range &error) {
            SAY("caught: %s", error.what());
        }
        try {
            throw 42;
        } catch (int number) {
            OS_TaskDelay(10);
            SAY("caught %d", number);
        }
        SAY("%s", dynamic_cast<Square *>(shape.get()) ? "a square" : "none");
    }
"""


@pytest.mark.slow
@pytest.mark.parametrize("tasks", ["thread", pytest.param("greenlet", marks=pytest.mark.slow)])
@pytest.mark.parametrize("link", ["static", pytest.param("shared", marks=pytest.mark.slow)])
def test_the_standard_library_and_exceptions(tmp_path: Path, link: str, tasks: str) -> None:
    compile_cpp(tmp_path, "TEST", LIBRARY, *LINKS[link])
    folder = write_mission(tmp_path, "TEST")
    assert not list(check_mission(tmp_path / "startup.scr"))
    console = console_of(fly(folder, tasks=tasks))
    [lengths, range_error, number, kind] = said(console)
    assert lengths == "a t=54 one=3 two=3 42 2.50"
    assert "vector::_M_range_check" in range_error
    assert [number, kind] == ["caught 42", "a square"]
    assert "has undefined symbols" not in console


@pytest.mark.slow
def test_run_has_one_digest(tmp_path: Path) -> None:
    compile_cpp(tmp_path, "TEST", LIBRARY)
    folder = write_mission(tmp_path, "TEST")
    assert len({digest_of(folder, tasks) for tasks in ("thread", "greenlet", "thread")}) == 1


@pytest.mark.parametrize("link", [pytest.param(link, marks=[pytest.mark.slow] * (link != "static")) for link in LINKS])
def test_uncaught_exception_is_a_fault(tmp_path: Path, link: str) -> None:
    source = """
        #include <stdexcept>
        extern "C" void TEST_Main()
        {
            uint32_t run = RUN;
            CFE_ES_RunLoop(&run);
            OS_TaskDelay(300);
            throw std::runtime_error("no fuel");
        }
    """
    compile_cpp(tmp_path, "TEST", source, *LINKS[link])
    make_safe(tmp_path)
    mission = fly(write_mission(tmp_path, "TEST"), 12)
    error = str(mission.cfe.es.history["TEST"].last_error)
    assert "terminate called after throwing an instance of 'std::runtime_error'" in error
    assert "no fuel" in error
    assert "Restart Application TEST Completed" in console_of(mission)


@pytest.mark.slow
def test_exceptions_of_two_tasks_do_not_mix(tmp_path: Path) -> None:
    console = fly_cpp(
        tmp_path,
        """
        #include <exception>
        #include <string>
        static void fly(const char *who)
        {
            for (int i = 0; i < 3; i++)
                try {
                    throw std::string(who) + std::to_string(i);
                } catch (const std::string &text) {
                    OS_TaskDelay(10);
                    try {
                        throw;
                    } catch (const std::string &again) {
                        SAY("%s %d", again.c_str(), again == text);
                    }
                }
        }
        static void child() { fly("child"); }
        extern "C" void TEST_Main()
        {
            uint32_t id;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
            fly("main");
            OS_TaskDelay(100);
        }
        """,
    )
    assert sorted(said(console)) == [f"{who}{i} 1" for who in ("child", "main") for i in range(3)]


LIFE = """
    int32_t OS_TaskGetId(void);
    struct Announced {
        const char *name;
        Announced(const char *given) : name(given) { SAY("%s begins", name); }
        ~Announced() { SAY("%s ends", name); }
    };
    static Announced first("first"), second("second");
    static Announced &late() { static Announced made("late"); return made; }
    extern "C" void TEST_Main()
    {
        SAY("main %s", late().name);
        SAY("main %s", late().name);
        Announced *heap = new Announced("heap"), *many = new Announced[2]{"many", "more"};
        delete heap;
        delete[] many;
        CFE_ES_ExitApp(EXIT);
    }
"""


@pytest.mark.parametrize("flags", [(), STATIC, FREE], ids=["shared", "static", "without libstdc++"])
def test_static_objects_are_constructed_and_destroyed(tmp_path: Path, flags: tuple[str, ...]) -> None:
    source = LIFE
    if flags is FREE:
        source = 'extern "C" { void *__dso_handle = &__dso_handle; }\n' + source.replace("\n    ", "\n")
    assert said(fly_cpp(tmp_path, source, *flags, seconds=10)) == [
        *("first begins", "second begins", "late begins", "main late", "main late"),
        *("heap begins", "many begins", "more begins", "heap ends", "more ends", "many ends"),
        *("late ends", "second ends", "first ends"),
    ]


def test_static_variable_is_initialised_once_when_two_tasks_need_it(tmp_path: Path) -> None:
    source = """
        static int made;
        struct Slow { int value; Slow() { OS_TaskDelay(50); value = ++made; } };
        static int get() { static Slow slow; return slow.value; }
        static void child() { SAY("child %d", get()); }
        extern "C" void TEST_Main()
        {
            uint32_t id;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
            SAY("main %d", get());
            OS_TaskDelay(100);
        }
    """
    for flags in ((), STATIC, ("-fno-exceptions", "-fno-rtti", "-nostdlib")):
        assert sorted(said(fly_cpp(tmp_path, source, *flags))) == ["child 1", "main 1"]


@pytest.mark.parametrize(
    ("code", "what"),
    [
        ("std::vector<int> numbers(*(volatile size_t *)&many);", "std::length_error"),
        ("std::function<void()> none; none();", "std::bad_function_call"),
        ("delete (int *)16;", "delete of 0x10, which new did not give"),
        ("int *volatile one = new int; delete one; delete one;", "which new did not give, or which was deleted"),
    ],
)
def test_code_without_exceptions_and_libstdcpp_has_faults_instead(tmp_path: Path, code: str, what: str) -> None:
    source = f"""
        #include <functional>
        #include <vector>
        static size_t many = ~(size_t)0;
        extern "C" void TEST_Main() {{ (void)many; {code} }}
    """
    compile_cpp(tmp_path, "TEST", source, "-fno-exceptions", "-fno-rtti", "-nostdlib", "-w")
    mission = fly(write_mission(tmp_path, "TEST"), 1)
    assert what in str(mission.cfe.es.history["TEST"].last_error)


@pytest.mark.slow
def test_mutex_of_the_standard_library_excludes_other_tasks(tmp_path: Path) -> None:
    console = fly_cpp(
        tmp_path,
        """
        #include <mutex>
        static std::mutex lock;
        static std::once_flag once;
        static void work(const char *who)
        {
            std::call_once(once, [] { SAY("once"); });
            std::lock_guard<std::mutex> holds(lock);
            SAY("%s in", who);
            OS_TaskDelay(100);
            SAY("%s out", who);
        }
        static void child() { work("child"); }
        extern "C" void TEST_Main()
        {
            uint32_t id;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 40, 0);
            work("main");
            OS_TaskDelay(200);
        }
        """,
    )
    assert said(console) == ["once", "main in", "main out", "child in", "child out"]


@pytest.mark.slow
def test_recursive_mutex_is_taken_twice_by_its_owner_only(tmp_path: Path) -> None:
    console = fly_cpp(
        tmp_path,
        """
        #include <pthread.h>
        static pthread_mutex_t lock;
        static void work(const char *who)
        {
            pthread_mutex_lock(&lock);
            pthread_mutex_lock(&lock);
            SAY("%s in", who);
            pthread_mutex_unlock(&lock);
            OS_TaskDelay(100);
            SAY("%s out", who);
            pthread_mutex_unlock(&lock);
        }
        static void child() { work("child"); }
        extern "C" void TEST_Main()
        {
            uint32_t id;
            pthread_mutexattr_t attributes;
            pthread_mutexattr_init(&attributes);
            pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
            pthread_mutex_init(&lock, &attributes);
            pthread_mutexattr_destroy(&attributes);
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 40, 0);
            work("main");
            OS_TaskDelay(200);
        }
        """,
    )
    assert said(console) == ["main in", "main out", "child in", "child out"]


@pytest.mark.slow
def test_check_without_libstdcpp_explains_how_to_link(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    compile_cpp(tmp_path, "TEST", LIBRARY)
    folder = write_mission(tmp_path, "TEST")
    host_library.cache_clear()
    monkeypatch.setattr("cfepy.extra.c.linking.find_library", lambda name: None)
    what = "not found on this computer; link the object with -static-libstdc++ -static-libgcc so that it is not needed"
    [problem] = check_mission(tmp_path / "startup.scr")
    assert what in problem.text
    assert f"OS_ModuleLoad: library libgcc_s.so.1 {what}" in console_of(fly(folder, 1))


@pytest.mark.slow
def test_std_thread_is_refused_with_the_calls_to_use_instead(tmp_path: Path) -> None:
    source = """
        #include <thread>
        extern "C" void TEST_Main()
        {
            std::thread other([]() {});
            other.join();
        }
    """
    told = fly_cpp(tmp_path, source, "-pthread")
    assert "pthread_create() was called, but cfepy and" in told
    assert (
        "do not define it; a task is made by OS_TaskCreate or CFE_ES_CreateChildTask, also in place of std::thread"
        in told
    )
    assert "died of an exception" in told
