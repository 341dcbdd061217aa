"""`threading.local`, keyed by task: the one of CPython is keyed by OS thread, and greenlet tasks share one.

The dictionary of the running task is put in place at each access, as CPython's own does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from weakref import ref

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def make_local(universe: Universe) -> type:
    """The class `_thread._local` of a universe."""
    kernel = universe.kernel
    get, put = object.__getattribute__, object.__setattr__

    def forget_at_end(self: Any, ident: int) -> None:
        """Values die with their thread, and with the object if that goes first."""
        weak = ref(self)

        def forget() -> None:
            alive = weak()
            if alive is not None:
                get(alive, "_local__state")[0].pop(ident, None)

        universe.at_thread_end(ident, forget)

    def switch(self: Any) -> None:
        states, args, options = get(self, "_local__state")
        ident = kernel.current.ident
        names = states.get(ident)
        if names is None:
            states[ident] = names = {}
            forget_at_end(self, ident)
            put(self, "__dict__", names)
            type(self).__init__(self, *args, **options)
        elif get(self, "__dict__") is not names:
            put(self, "__dict__", names)

    class _local:
        """Attributes that every thread has for itself."""

        __slots__ = ("__dict__", "__weakref__", "_local__state")

        def __new__(cls, *args: Any, **options: Any) -> _local:
            if (args or options) and cls.__init__ is object.__init__:
                raise TypeError("Initialization arguments are not supported")
            self = super().__new__(cls)
            ident = kernel.current.ident
            states: dict[int, dict[str, Any]] = {ident: get(self, "__dict__")}
            put(self, "_local__state", (states, args, options))
            forget_at_end(self, ident)
            return self

        def __getattribute__(self, name: str) -> Any:
            switch(self)
            return get(self, name)

        def __setattr__(self, name: str, value: Any) -> None:
            switch(self)
            put(self, name, value)

        def __delattr__(self, name: str) -> None:
            switch(self)
            object.__delattr__(self, name)

    _local.__module__ = "_thread"
    return _local
