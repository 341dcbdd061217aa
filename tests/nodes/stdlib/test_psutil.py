"""`psutil` in a node: the load of the simulated processor, the same on every host."""

from __future__ import annotations


def test_load_shows_the_processor_of_the_node(run):
    program = run(
        """
        import psutil, time
        psutil.cpu_percent()
        while time.monotonic() < 1.0:  # each look at the clock is processor time
            pass
        time.sleep(1.0)
        print(psutil.cpu_percent(), psutil.cpu_percent(interval=0.5), psutil.cpu_count())
        print(psutil.Process().cpu_percent(0.1), psutil.Process().num_threads(), len(psutil.cpu_percent(percpu=True)))
        """
    )
    assert program.lines == ["50.0 0.0 1", "0.0 1 1"]


def test_memory_shows_an_idle_computer(run):
    program = run(
        """
        import os, psutil
        mine = os.getpid()
        print(psutil.virtual_memory().percent, psutil.Process(mine).pid == mine, psutil.pids() == [mine])
        print(psutil.sensors_temperatures(), psutil.disk_usage("/").percent, psutil.net_io_counters().bytes_sent)
        try:
            psutil.Process(1)
        except psutil.NoSuchProcess as error:
            print(error)
        """
    )
    assert program.lines == ["0.0 True True", "{} 0.0 0", "process PID not found (pid=1)"]


def test_process_has_no_connections(run):
    program = run("import psutil\nprint(psutil.Process().net_connections(), psutil.Process().connections('tcp'))")
    assert program.lines == ["[] []"]


def test_disk_is_empty_for_every_function(run):
    program = run(
        """
        import os, psutil, shutil
        found = os.statvfs(".")
        sizes = {shutil.disk_usage("/").free, psutil.disk_usage("/").free, found.f_bavail * found.f_frsize}
        print(sizes == {1 << 30}, shutil.disk_usage("/").used, found.f_fsid)
        try:
            shutil.disk_usage("/none")
        except FileNotFoundError as error:
            print(error)
        """
    )
    assert program.lines == ["True 0 0", "[Errno 2] No such file or directory: '/none'"]
