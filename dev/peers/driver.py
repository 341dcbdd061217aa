"""Run one file of tests as nose and pytest would, in a node, and write the result of each test as JSON.

Its arguments are the test file and the path of the results. Tests are methods `test*` of classes derived from
`unittest.TestCase` or called `Test*`, and functions `test*`.
"""

from __future__ import annotations

import importlib
import inspect
import json
import os
import sys
import traceback
import unittest
from types import ModuleType


def import_file(path: str) -> ModuleType:
    """Import a file as part of its enclosing packages, whose folder is then searched first."""
    folder, name = os.path.split(os.path.splitext(path)[0])
    while os.path.isfile(os.path.join(folder, "__init__.py")):
        folder, package = os.path.split(folder)
        name = f"{package}.{name}"
    sys.path[0] = folder  # in place of this program's own
    return importlib.import_module(name)


def tests_of(module: ModuleType) -> unittest.TestSuite:
    """Return all tests of a module, each class in the order of its names, plain functions last."""
    suite = unittest.TestSuite()
    for name, value in list(vars(module).items()):
        if inspect.isclass(value) and issubclass(value, unittest.TestCase):
            if value.__module__ == module.__name__ or name.lower().startswith("test"):
                suite.addTest(unittest.defaultTestLoader.loadTestsFromTestCase(value))
        elif inspect.isclass(value) and name.startswith("Test") and value.__module__ == module.__name__:
            suite.addTests(plain(value, each) for each in dir(value) if each.startswith("test"))
        elif inspect.isfunction(value) and name.startswith("test") and value.__module__ == module.__name__:
            suite.addTest(unittest.FunctionTestCase(value, description=name))
    return suite


def plain(kind: type, method: str) -> unittest.FunctionTestCase:
    """Return a method of a class that is not derived from TestCase, on an object of its own."""
    holder = kind()
    set_up, tear_down = (getattr(holder, name, None) for name in ("setup_method", "teardown_method"))
    return unittest.FunctionTestCase(getattr(holder, method), set_up, tear_down, f"{kind.__name__}.{method}")


class Results(unittest.TestResult):
    """Result of each test, by name: "passed", "skipped", or the error."""

    def __init__(self) -> None:
        super().__init__()
        self.said: dict[str, str] = {}

    def startTest(self, test: unittest.TestCase) -> None:
        super().startTest(test)
        self.said[name_of(test)] = "passed"

    def addError(self, test: unittest.TestCase, err: object) -> None:
        """See unittest. An error in the set-up of a class or module belongs to no test."""
        self.said[name_of(test)] = text_of(err)

    addFailure = addError

    def addSubTest(self, test: unittest.TestCase, subtest: object, err: object) -> None:
        if err is not None:
            self.addError(test, err)

    def addSkip(self, test: unittest.TestCase, reason: str) -> None:
        self.said[name_of(test)] = "skipped"

    def addExpectedFailure(self, test: unittest.TestCase, err: object) -> None:
        """See unittest. Counts as a test that did not run, as other tools count it."""
        self.said[name_of(test)] = "skipped"

    def addUnexpectedSuccess(self, test: unittest.TestCase) -> None:
        self.said[name_of(test)] = "passes unexpectedly"


def name_of(test: unittest.TestCase) -> str:
    """Return the name of a test without its module's."""
    if isinstance(test, unittest.FunctionTestCase):
        return test.shortDescription() or test.id()
    return ".".join(test.id().split(".")[-2:])


def text_of(error: object) -> str:
    """Return an error with its traceback."""
    return "".join(traceback.format_exception(*error))  # type: ignore[misc]


def main(path: str, results_file: str) -> None:
    """Run the tests of a file."""
    sys.argv = [path]
    try:
        suite = tests_of(import_file(path))
    except (Exception, SystemExit):
        said = {"import": traceback.format_exc()}
    else:
        results = Results()
        suite.run(results)
        said = results.said
    with open(results_file, "w", encoding="utf-8") as stream:
        json.dump(said, stream)


if __name__ == "__main__":
    main(*sys.argv[1:])
    os._exit(0)  # threads that a test left behind do not matter any more
