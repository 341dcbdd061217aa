"""Databases of sqlite3: a connection waits for a lock in virtual time, and in no other case than SQLite does."""

from __future__ import annotations

from pathlib import Path
from typing import Any

HEAD = """
import sqlite3, time
def connect(**options):
    return sqlite3.connect("FILE", timeout=1, **options)
with connect() as made:
    made.execute("CREATE TABLE counts (n INTEGER)")
    made.execute("INSERT INTO counts VALUES (0)")
def told(action, *words):
    start = time.monotonic()
    try:
        action(*words)
        result = "done"
    except sqlite3.OperationalError as error:
        result = str(error)
    print(result, round(time.monotonic() - start, 1))
"""


def printed(run: Any, folder: Path, lines: str) -> list[str]:
    """Return the lines that a program with a database in a folder prints."""
    text: str = run(HEAD.replace("FILE", str(folder / "counts.db")) + lines).text
    return text.splitlines()


def test_write_waits_for_the_transaction_of_another_connection(run: Any, tmp_path: Path) -> None:
    lines = """
a, b = connect(), connect()
told(a.execute, "UPDATE counts SET n = 1")
told(b.execute, "UPDATE counts SET n = 2")
told(a.commit)
told(b.execute, "UPDATE counts SET n = 2")
"""
    assert printed(run, tmp_path, lines) == ["done 0.0", "database is locked 1.0", "done 0.0", "done 0.0"]


def test_transaction_that_has_read_does_not_wait_to_write(run: Any, tmp_path: Path) -> None:
    """These are the results of SQLite 3.40 on Linux."""
    lines = """
a, b = connect(isolation_level=None), connect(isolation_level=None)
for each in (a, b):
    each.execute("BEGIN")
    each.execute("SELECT * FROM counts").fetchall()
told(a.execute, "UPDATE counts SET n = 1")
told(b.execute, "UPDATE counts SET n = 2")
told(a.execute, "COMMIT")
told(b.execute, "ROLLBACK")
told(a.execute, "COMMIT")
"""
    assert printed(run, tmp_path, lines) == [
        "done 0.0",
        "database is locked 0.0",
        "database is locked 1.0",
        "done 0.0",
        "done 0.0",
    ]
