"""Properties of a process: arguments, environment, directory, streams, signals, exit."""

from __future__ import annotations

import os
import sys

import pytest

from tests.own_paths import own_files


def test_environment_refuses_as_python_does_and_shows_only_variables_of_the_node(run):
    code = """
        import os
        print(type(os.environ).__name__, isinstance(os.environ, dict), repr(os.environ)[:9])
        os.environ["X"] = "1"
        print(os.environb[b"X"], os.getenvb(b"X"), b"CFEPY_OF_HOST" in os.environb)
        for name, value in ((1, "a"), ("a", 1), (b"a", "a"), ("A=B", "1"), ("A", "\\0"), ("", "1")):
            try:
                os.environ[name] = value
            except Exception as error:
                print(type(error).__name__, error)
        for call in (lambda: 1 in os.environ, lambda: os.getenv(b"X"), lambda: os.environ["NONE"]):
            try:
                print(call())
            except Exception as error:
                print(type(error).__name__, error)
    """
    os.environ["CFEPY_OF_HOST"] = "1"
    try:
        lines = run(code).lines
    finally:
        del os.environ["CFEPY_OF_HOST"]
    assert lines == [
        "_Environ False environ({",
        "b'1' b'1' False",
        *("TypeError str expected, not int", "TypeError str expected, not int", "TypeError str expected, not bytes"),
        *("ValueError illegal environment variable name", "ValueError embedded null byte"),
        "OSError [Errno 22] Invalid argument",
        *("TypeError str expected, not int", "TypeError str expected, not bytes", "KeyError 'NONE'"),
    ]


def test_arguments_environment_and_names(run, tmp_path):
    program = run(
        """
        import os, sys
        print(sys.argv[1:], os.path.basename(sys.argv[0]), os.environ["ROBOT"], os.getenv("NONE"), __name__)
        print(os.path.basename(__file__), sys.path[0] == os.path.dirname(__file__))
        os.environ["ADDED"] = "1"
        """,
        argv=["a", "_x:=1"],
        env={"ROBOT": "r2"},
    )
    assert program.lines == ["['a', '_x:=1'] node.py r2 None __main__", "node.py True"]
    assert "ADDED" not in os.environ


def test_working_directory_is_virtual(run, tmp_path):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "data.txt").write_text("hello", encoding="utf-8")
    host = os.getcwd()
    program = run(
        """
        import glob, os, pathlib
        print(os.getcwd() == os.path.dirname(__file__))
        os.chdir("sub")
        print(open("data.txt").read(), os.listdir(), os.path.exists("data.txt"), os.path.isfile("none"))
        print(pathlib.Path("data.txt").read_text(), pathlib.Path.cwd().name, os.path.basename(os.path.abspath(".")))
        os.makedirs("a/b"); os.rename("a", "c"); print(sorted(os.listdir(".")), glob.glob("*.txt"))
        print([names for _, names, _ in os.walk("c")])
        try:
            os.chdir("nowhere")
        except FileNotFoundError:
            print("refused")
        """,
        cwd=tmp_path,
    )
    assert program.lines == [
        "True",
        "hello ['data.txt'] True False",
        "hello sub sub",
        "['c', 'data.txt'] ['data.txt']",
        "[['b'], []]",
        "refused",
    ]
    assert os.getcwd() == host


@pytest.mark.parametrize(
    ("body", "status", "shown"),
    [
        ("pass", 0, ""),
        ("sys.exit()", 0, ""),
        ("sys.exit(3)", 3, ""),
        ("sys.exit(-1)", 255, ""),
        ("sys.exit(True)", 1, ""),
        ("sys.exit('bad')", 1, "bad"),
        ("exit(4)", 4, ""),
        ("os._exit(5)", 5, ""),
        ("threading.Thread(target=os._exit, args=(6,)).start(); time.sleep(9)", 6, ""),
        ("os.kill(os.getpid(), signal.SIGTERM)", 143, ""),
    ],
)
def test_exit_status(start, body, status, shown):
    program = start(f"import os, signal, sys, threading, time\n{body}\n")
    program.kernel.run()
    assert program.universe.exit_status == status
    assert program.text == shown
    assert program.universe.tasks == ()


def test_keyboard_interrupt_that_the_program_raises_ends_it_alone(run):
    program = run("import atexit\natexit.register(print, 'hook')\nraise KeyboardInterrupt('why')\n")
    assert program.universe.exit_status == 130
    assert program.text.splitlines()[2:] == ["    raise KeyboardInterrupt('why')", "KeyboardInterrupt: why", "hook"]


def test_uncaught_error_shows_the_nodes_lines_only(run):
    program = run("""
        import time
        def level():
            raise ValueError("boom")
        def main():
            try:
                level()
            except ValueError as error:
                raise RuntimeError("outer") from error
        main()
    """)
    assert program.universe.exit_status == 1
    assert isinstance(program.universe.error, RuntimeError)
    assert program.lines[0] == "Traceback (most recent call last):"
    assert program.lines[-1] == "RuntimeError: outer"
    files = {line.split('"')[1] for line in program.lines if line.startswith("  File")}
    assert {os.path.basename(file) for file in files} == {"node.py"}


def test_own_tracebacks_of_a_node_hide_the_simulator(run):
    program = run("""
        import time, traceback
        try:
            time.sleep(-1)
        except ValueError:
            traceback.print_exc()
    """)
    assert sum(line.startswith("  File") for line in program.lines) == 1
    assert own_files(program.text) == []


def test_syntax_error(run):
    program = run("x = = 1\n")
    assert program.lines[-1] == "SyntaxError: invalid syntax"
    assert program.universe.exit_status == 1


def test_exit_hooks_run_last_to_first_after_the_threads(run):
    program = run("""
        import atexit, threading, time
        atexit.register(print, "first")
        atexit.register(lambda: 1 / 0)
        @atexit.register
        def second():
            print("second", time.monotonic() >= 1)
        threading.Timer(1, print, ("thread",)).start()
        threading.Thread(target=time.sleep, args=(99,), daemon=True).start()
        print("main")
    """)
    assert [line for line in program.lines if line[0] not in " TEZ"] == ["main", "thread", "second True", "first"]
    assert "ZeroDivisionError: division by zero" in program.lines
    assert program.kernel.now < 2e9


def test_print_and_streams_reach_the_console(run, capsys):
    program = run("""
        import io, sys, contextlib
        print("a", 1, sep="-", end="."); print("b")
        sys.stderr.write("half "); sys.stderr.write("line\\nrest")
        sys.stdout.buffer.write("b\\u00fctes\\n".encode())
        with contextlib.redirect_stdout(io.StringIO()) as caught:
            print("hidden")
        print(repr(caught.getvalue()), sys.stdout.isatty(), sys.stdin.read() == "")
        try:
            input("name? ")
        except EOFError:
            print("no input")
    """)
    assert program.lines == ["a-1.b", "half line", "b\u00fctes", "'hidden\\n' False True", "name? no input", "rest"]
    assert capsys.readouterr() == ("", "")
    assert sys.stdout is not program.universe.stdout


def test_signal_handlers_are_set_in_the_main_thread_only(run):
    program = run(
        """
        import signal, threading
        def attempt(function, *args):
            try:
                function(*args)
            except (ValueError, RuntimeError) as error:
                print(type(error).__name__, error)
            else:
                print("done")
        def all_of():
            attempt(signal.signal, signal.SIGTERM, signal.SIG_IGN)
            attempt(signal.set_wakeup_fd, -1)
            attempt(signal.getsignal, signal.SIGTERM)
        all_of()
        thread = threading.Thread(target=all_of)
        thread.start()
        thread.join()
        """
    )
    assert program.lines == [
        *["done"] * 3,
        "ValueError signal only works in main thread of the main interpreter",
        "ValueError set_wakeup_fd only works in main thread of the main interpreter",
        "done",
    ]


def test_signals_are_the_nodes_own(run):
    import signal

    before = signal.getsignal(signal.SIGINT)
    program = run("""
        import os, signal
        print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)
        try:
            os.kill(os.getpid(), signal.SIGINT)
        except KeyboardInterrupt:
            print("interrupted")
        signal.signal(signal.SIGINT, lambda number, frame: print("handled", number))
        signal.raise_signal(signal.SIGINT)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        os.kill(os.getpid(), signal.SIGTERM)
    """)
    assert program.lines == ["True", "interrupted", "handled 2"]
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize(
    "body",
    [
        "import socket; socket.socket()",
        "import socket; socket.create_connection(('localhost', 1))",
        "import subprocess; subprocess.run(['ls'])",
        "import subprocess; subprocess.Popen('ls')",
        "import multiprocessing; multiprocessing.Process(target=print)",
        "from multiprocessing.pool import Pool; Pool(2)",
        "import multiprocessing\nclass Worker(multiprocessing.Process): pass\nWorker()",
        "import os; os.fork()",
        "import os; os.system('ls')",
        "import select; select.select([3], [], [])",
        "import signal; signal.alarm(1)",
        "import os; os.kill(1, 9)",
        "import asyncio; asyncio.run(asyncio.open_connection('localhost', 1))",
        "import ssl",
        "import OpenSSL",
        "import xmlrpc.client; xmlrpc.client.ServerProxy('http://localhost:1').f()",
    ],
)
def test_unsupported_operations_are_refused(run, body):
    program = run(body)
    assert program.universe.exit_status == 1
    assert "is not available on the simulated computer; " in program.lines[-1]


def test_modules_with_unsupported_functions_can_be_imported(run):
    program = run("""
        import http.server, logging.handlers, multiprocessing, select, socket, socketserver, subprocess, urllib.request
        print(socket.gethostname(), multiprocessing.cpu_count(), select.select([], [], [], 0.5))
        try:
            socket.socket()
        except socket.error:
            print("caught")
    """)
    assert program.lines == ["cfepy 1 ([], [], [])", "caught"]


def test_two_nodes_share_no_state(start, tmp_path):
    (tmp_path / "counter.py").write_text("value = 0\n", encoding="utf-8")
    source = """
        import builtins, counter, logging, os, random, sys, threading, time
        logging.basicConfig(level=logging.DEBUG if sys.argv[1] == "1" else logging.ERROR, format="%(message)s")
        builtins.mark = sys.argv[1]
        for _ in range(3):
            counter.value += 1
            time.sleep(1)
        logging.info("info")
        print(counter.value, os.getpid() > 1, mark, threading.active_count(), sys.modules["counter"] is counter)
        numbers = random.random(), random.Random().random(), os.urandom(4), os.getpid()
    """
    one = start(source, name="one", argv=["1"])
    two = start(source, name="two", argv=["2"])
    one.kernel.run()
    assert one.lines == ["info", "3 True 1 1 True"]
    assert two.lines == ["3 True 2 1 True"]
    assert not set(one.global_("numbers")) & set(two.global_("numbers"))


def test_settings_of_a_process_stay_in_the_node(run):
    import gc
    import locale

    before = (gc.isenabled(), gc.get_threshold(), len(gc.callbacks), locale.setlocale(locale.LC_ALL))
    program = run("""
        import gc, locale, os, resource, time
        print(gc.isenabled(), gc.get_threshold(), gc.callbacks, gc.collect() >= 0)
        gc.disable(); gc.set_threshold(1); gc.callbacks.append(print); gc.freeze(); gc.unfreeze(); gc.set_debug(0)
        print(gc.isenabled(), gc.get_threshold(), gc.get_debug(), locale.setlocale(locale.LC_NUMERIC))
        print(locale.setlocale(locale.LC_ALL, "de_DE.UTF-8"), locale.setlocale(locale.LC_NUMERIC), f"{1.5:n}")
        for _ in range(1000): time.time()
        used = resource.getrusage(resource.RUSAGE_SELF)
        print(used.ru_utime >= 0.001, used.ru_maxrss, resource.getrlimit(resource.RLIMIT_NOFILE)[0], os.getloadavg())
    """)
    assert program.lines == [
        "True (700, 10, 10) [] True",
        "False (1, 10, 10) 0 C",
        "de_DE.UTF-8 de_DE.UTF-8 1.5",
        "True 0 -1 (0.0, 0.0, 0.0)",
    ]
    assert (gc.isenabled(), gc.get_threshold(), len(gc.callbacks), locale.setlocale(locale.LC_ALL)) == before


def test_open_files_are_flushed_at_the_end(run, tmp_path):
    program = run(
        """
        import csv, io, pathlib
        table = csv.writer(open("table.csv", "w", newline=""))
        table.writerow([1, 2])
        kept = [io.open("bytes.bin", "wb"), pathlib.Path("text.txt").open("w")]
        kept[0].write(b"octets")
        kept[1].write("letters")
        def use(): return table, kept
        raise RuntimeError("the end")
        """,
        cwd=tmp_path,
    )
    assert "the end" in program.text
    assert (tmp_path / "table.csv").read_bytes() == b"1,2\r\n"
    assert (tmp_path / "bytes.bin").read_bytes() == b"octets"
    assert (tmp_path / "text.txt").read_text(encoding="utf-8") == "letters"


def test_files_of_a_killed_program_are_flushed(start, tmp_path):
    program = start("kept = open('kept.txt', 'w'); kept.write('words')\nimport time; time.sleep(100)", cwd=tmp_path)
    program.kernel.run(10**9)
    program.kernel.unwind()
    assert (tmp_path / "kept.txt").read_text(encoding="utf-8") == "words"


def test_ssl_is_refused_without_advice_about_realtime(run):
    assert "--realtime" not in run("import ssl").lines[-1]
