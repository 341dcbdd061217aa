"""Functions of libc that take memory: aligned blocks, copies of texts."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extra.c.building import compile_c, console_of, fly, needs_compiler, said, write_mission

pytestmark = needs_compiler

SOURCE = """
int posix_memalign(void **out, unsigned long alignment, unsigned long size);
void *aligned_alloc(unsigned long alignment, unsigned long size);
char *strdup(const char *text);
char *strndup(const char *text, unsigned long most);

void TEST_Main(void)
{
    char *first = aligned_alloc(4096, 100), *between = malloc(100), *second = aligned_alloc(4096, 100), *third = 0;
    char *again, *copy;
    SAY("aligned %lu %lu %d", (unsigned long)first % 4096, (unsigned long)second % 4096, first != second);
    memset(second, 7, 100);
    free(first);
    SAY("to be taken again %d", (again = malloc(100)) == first && again != between);
    free(between);
    free(again);
    SAY("the one that is aligned %d", aligned_alloc(4096, 100) == first && second[99] == 7);
    SAY("posix_memalign %d %lu", posix_memalign((void **)&third, 256, 10), (unsigned long)third % 256);
    SAY("refused %d %d", aligned_alloc(48, 10) == 0, posix_memalign((void **)&third, 4, 10) == 22);
    SAY("too large %d", aligned_alloc(64, 1ul << 40) == 0 && aligned_alloc(1ul << 40, 64) == 0);
    copy = strndup("abcdef", 3);
    SAY("%s %s", strdup("text"), copy);
    free(copy);
}
"""
LINES = [
    "aligned 0 0 1",
    "to be taken again 1",
    "the one that is aligned 1",
    "posix_memalign 0 0",
    "refused 1 1",
    "too large 1",
    "text abc",
]


@pytest.mark.parametrize("guard", [False, True])
def test_blocks_are_aligned_and_texts_copied(tmp_path: Path, guard: bool) -> None:
    compile_c(tmp_path, "TEST", SOURCE, "-O0", "-w")
    folder = write_mission(tmp_path, "TEST")
    Path(folder, "mission.yaml").write_text(f"compiled: {{guard: {str(guard).lower()}}}\n", encoding="utf-8")
    found = said(console_of(fly(folder, 1)))
    if guard:  # a block that was given back is never taken again
        assert [found[0], *found[3:]] == [LINES[0], *LINES[3:]]
    else:
        assert found == LINES


LARGE = """
void TEST_Main(void)
{
    unsigned long sizes[] = {3000000, 5000000, 100000000, 600000000, 2000000000};
    for (int i = 0; i < 5; i++)
    {
        char *block = malloc(sizes[i]);
        if (block != 0)
            block[0] = block[sizes[i] - 1] = 1;
        SAY("%lu %d", sizes[i], block != 0);
    }
}
"""


def test_large_blocks_are_given_until_memory_ends(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", LARGE, "-O0", "-w")
    found = said(console_of(fly(write_mission(tmp_path, "TEST"), 1)))
    assert found == ["3000000 1", "5000000 1", "100000000 1", "600000000 1", "2000000000 0"]
