"""A node's own rand(): the numbers of glibc, which nodes on Linux get."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from dev.roscfe.building import ROSCFE, compile_program, needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

PROGRAM = """
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

extern "C" {
int __wrap_rand();
void __wrap_srand(unsigned int seed);
long __wrap_random();
}

static int differ()
{
    int count = 0;
    for (int i = 0; i < 100000; ++i)
    {
        count += i % 7 == 0 ? __wrap_random() != random() : __wrap_rand() != std::rand();
    }
    return count;
}

int main()
{
    std::printf("%d", differ()); // as if srand(1) had been called
    for (unsigned int seed : {0U, 1U, 2U, 42U, 2147483647U, 2147483648U, 4294967295U})
    {
        std::srand(seed);
        __wrap_srand(seed);
        std::printf(" %d", differ());
    }
}
"""


def test_random_numbers_equal_glibc(tmp_path: Path) -> None:
    source = tmp_path / "numbers.cpp"
    source.write_text(PROGRAM, encoding="utf-8")
    made = compile_program(tmp_path / "numbers", [source, ROSCFE / "src/random.cpp"])
    assert subprocess.run([made], capture_output=True, text=True, check=True).stdout == "0 0 0 0 0 0 0 0"
