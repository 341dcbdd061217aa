"""Files of POSIX in compiled applications: the same program prints the same on this computer and in flight."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.pilot.mission_check import check_mission
from cfepy.writing.console import Console
from tests.extra.c.building import (
    compile_c,
    compile_cpp,
    console_of,
    fly,
    fly_c,
    make_safe,
    needs_compiler,
    needs_cpp,
    said,
    write_mission,
)
from tests.extra.c.posix.comparing import FORTIFIED, compare

pytestmark = needs_compiler


@pytest.mark.parametrize("name", ["files", "streams"])
def test_program_prints_the_same_in_flight(tmp_path: Path, name: str) -> None:
    compare(tmp_path, name)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["files", "streams"])
def test_fortified_program_prints_the_same_in_flight(tmp_path: Path, name: str) -> None:
    compare(tmp_path, name, *FORTIFIED)


def test_files_are_shared_with_osal(tmp_path: Path) -> None:
    source = r"""
        #include <stdio.h>
        #include <fcntl.h>
        #include <unistd.h>
        #include <errno.h>
        int32_t OS_OpenCreate(uint32_t *, const char *, int32_t, int32_t);
        int32_t OS_read(uint32_t, void *, size_t);
        void TEST_Main(void)
        {
            char data[16] = "";
            uint32_t id;
            FILE *file = fopen("ram/notes.txt", "w");
            SAY("number %d", fileno(file));
            fputs("notes", file);
            SAY("before %d", OS_OpenCreate(&id, "/ram/notes.txt", 0, 0) ? -1 : (int)OS_read(id, data, 16));
            fclose(file);
            int32_t count = OS_read(id, data, 16);
            SAY("after %d %s", count, data);
            int number = open("/ram/full.bin", O_WRONLY | O_CREAT, 0600);
            static char block[3 << 20];
            SAY("room %d", (int)write(number, block, sizeof block) == (2 << 20) - 5);
            int status = write(number, block, 1);
            SAY("full %d %d", status, errno == ENOSPC);
            file = fopen("/ram/more.txt", "w");
            status = fprintf(file, "lost");
            SAY("buffered %d", status);
            status = fclose(file);
            SAY("close %d %d", status, errno == ENOSPC);
        }
    """
    found = said(fly_c(tmp_path, source))
    expected = ["number 3", "before 0", "after 5 notes", "room 1", "full -1 1", "buffered 4", "close -1 1"]
    assert found == expected


def test_path_outside_does_not_exist_and_is_named_once(tmp_path: Path) -> None:
    source = r"""
        #include <stdio.h>
        #include <fcntl.h>
        #include <errno.h>
        void TEST_Main(void)
        {
            static const char *const paths[] = {"/sys/class/thermal/temp", "/dev/i2c-1", "../../etc/passwd"};
            for (int i = 0; i < 6; i++)
            {
                errno = 0;
                int number = i % 3 ? open(paths[i % 3], O_RDONLY) : fopen(paths[0], "r") ? 1 : -1;
                SAY("%d %d", number, errno == ENOENT);
            }
        }
    """
    console = fly_c(tmp_path, source)
    assert said(console) == ["-1 1"] * 6
    assert [each for each in console.splitlines() if "errno is" in each] == [
        "TEST: fopen() of /sys/class/thermal/temp: it is not in the file systems of the mission (/cf, /ram);"
        " errno is ENOENT",
        "TEST: open() of /dev/i2c-1: it is not a device of the mission (`devices:` in the mission file);"
        " errno is ENOENT",
        "TEST: open() of ../../etc/passwd: it is not in the file systems of the mission (/cf, /ram); errno is ENOENT",
    ]


def test_files_stay_open_when_their_application_ends(tmp_path: Path) -> None:
    source = r"""
        #include <stdio.h>
        void TEST_Main(void)
        {
            FILE *file = fopen("cf/log.txt", "a");
            SAY("number %d at %ld", fileno(file), ftell(file));
            fputs("run", file);
            uint32_t run = 1;
            CFE_ES_RunLoop(&run);
            OS_TaskDelay(9000);
        }
    """
    compile_c(tmp_path, "TEST", source)
    folder = write_mission(tmp_path, "TEST")
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(3)
        mission.cfe.es.restart_app(mission.cfe.es.get_app_id_by_name("TEST"))
        mission.run_for(10)
        assert mission.cfe.os.files.read_file("/cf/log.txt") == b""
        files, lines = mission.cfe.os.files, said(console_of(mission))
    assert lines == ["number 3 at 0", "number 4 at 0"]
    assert files.read_file("/cf/log.txt") == b"runrun"  # the end of the process writes all buffers


def test_buffers_are_lost_when_the_process_aborts(tmp_path: Path) -> None:
    source = r"""
        #include <stdio.h>
        void TEST_Main(void)
        {
            FILE *file = fopen("cf/log.txt", "w");
            fputs("whole", file);
            fflush(file);
            fputs(" lost", file);
            abort();
        }
    """
    compile_c(tmp_path, "TEST", source)
    with Mission(write_mission(tmp_path, "TEST"), console=Console(quiet=True)) as mission:
        mission.run_for(1)
        files = mission.cfe.os.files
    assert files.read_file("/cf/log.txt") == b"whole"


def test_closed_file_is_a_fault(tmp_path: Path) -> None:
    source = r"""
        #include <stdio.h>
        void TEST_Main(void)
        {
            FILE *file = fopen("cf/log.txt", "w");
            fclose(file);
            fputc('x', file);
        }
    """
    make_safe(tmp_path)
    console = fly_c(tmp_path, source, flags=("-Wno-use-after-free",))
    assert re.search(r"CFault: 0x[0-9a-f]+ is not an open FILE, in TEST_Main \(TEST\.c:6\)", console)


@needs_cpp
def test_streams_of_cpp_use_files(tmp_path: Path) -> None:
    source = r"""
        #include <fstream>
        #include <string>
        extern "C" void TEST_Main(void)
        {
            std::ofstream("cf/values.txt") << 1.5 << " two\nthree";
            std::ifstream from("cf/values.txt");
            double value;
            std::string word, line;
            from >> value >> word >> line;
            CFE_ES_WriteToSysLog("> %g %s %s %d\n", value, word.c_str(), line.c_str(), from.eof());
            CFE_ES_WriteToSysLog("> %d\n", std::ifstream("cf/none").is_open());
        }
    """
    compile_cpp(tmp_path, "TEST", source)
    assert said(console_of(fly(write_mission(tmp_path, "TEST"), 1))) == ["1.5 two three 1", "0"]


def test_check_names_only_functions_without_files_of_the_mission(tmp_path: Path) -> None:
    source = r"""
        #include <stdio.h>
        #include <unistd.h>
        void TEST_Main(void)
        {
            int ends[2];
            fclose(fopen("cf/x", "r"));
            tmpfile();
            if (pipe(ends)) {}
        }
    """
    compile_c(tmp_path, "TEST", source)
    [text] = [each.text for each in check_mission(write_mission(tmp_path, "TEST"))]
    assert re.sub(r" \(TEST\.c:\d+\)", "", text) == (
        "TEST needs tmpfile, but only files and folders of the mission are available;"
        " use fopen, open or OS_OpenCreate; calling it is a fault"
    )
