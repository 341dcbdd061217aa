"""Random numbers of a node: everything that Python seeds from the operating system comes from the node's own stream,
derived from the seed of the run and the node's name. NumPy's module-level generator is per node too.
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.files.shared import array_files
from cfepy.nodes.made_modules import proxy

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_GENERATORS = ("RandomState", "SeedSequence", "MT19937", "PCG64", "PCG64DXSM", "Philox", "SFC64")


def fix_random(universe: Universe, module: ModuleType) -> None:
    """Fix `random` after loading: a `Random()` without a seed asks C code for entropy, so one is given to it."""
    generators: Any = module.Random
    seed = generators.seed

    def seed_from_node(generator: Any, a: Any = None, version: int = 2) -> None:
        seed(generator, universe.rng.getrandbits(128) if a is None else a, version)

    generators.seed = seed_from_node
    vars(module)["seed"] = module._inst.seed
    module._inst.seed()


def numpy_module(universe: Universe) -> ModuleType:
    """Return the host's NumPy with a `random` of the node's own."""
    import numpy

    load = universe.importer.load

    def lookup(name: str) -> Any:
        """NumPy loads most of its parts on first use."""
        value = getattr(numpy, name)
        return load(value.__name__) if _is_part(name, value) else value

    module = proxy(numpy, __getattr__=lookup, **array_files(universe, numpy))
    universe.importer.modules["numpy"] = module
    for name in [name for name, value in vars(numpy).items() if _is_part(name, value)]:
        del vars(module)[name]
    return module


def _is_part(name: str, value: object) -> bool:
    """Return whether a name in NumPy is a public module that is copied for each node."""
    return isinstance(value, ModuleType) and value.__name__ == f"numpy.{name}" and not name.startswith("_")


def numpy_random_module(universe: Universe) -> ModuleType:
    """Return `numpy.random`: its functions use a generator of this node, and a generator without a seed gets one."""
    host = importlib.import_module("numpy.random")
    state = host.RandomState(universe.rng.getrandbits(32))
    own: dict[str, Any] = {name: getattr(state, name) for name in host.__all__ if hasattr(state, name)}
    own.update(dict.fromkeys(("ranf", "sample"), state.random_sample))
    own.update({name: _seeded_class(universe, getattr(host, name)) for name in _GENERATORS})

    def seed(seed: Any = None) -> None:
        state.seed(universe.rng.getrandbits(32) if seed is None else seed)

    own["seed"] = seed

    def default_rng(seed: Any = None) -> Any:
        return host.default_rng(universe.rng.getrandbits(128) if seed is None else seed)

    return proxy(host, **own, default_rng=default_rng)


def _seeded_class(universe: Universe, generator: Any) -> type:
    """Return a generator class that takes its seed from the node's stream if none is given."""

    def start(self: Any, seed: Any = None, *args: Any, **options: Any) -> None:
        generator.__init__(self, universe.rng.getrandbits(32) if seed is None else seed, *args, **options)

    def seed_again(self: Any, seed: Any = None) -> None:
        generator.seed(self, universe.rng.getrandbits(32) if seed is None else seed)

    again = {"seed": seed_again} if hasattr(generator, "seed") else {}
    return type(generator.__name__, (generator,), {"__init__": start, **again})
