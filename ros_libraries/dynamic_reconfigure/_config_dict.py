"""`Config`: a dict whose items are also attributes. A server's callback gets it."""

from __future__ import annotations

import copy
from typing import Any


class Config(dict[str, Any]):
    """Values by parameter name; `groups` holds the tree of groups."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)

    def __getattr__(self, name: str) -> Any:
        return self[name]

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value

    def copy(self) -> Config:
        """Return a flat copy."""
        return Config(self)

    def __deepcopy__(self, memo: Any) -> Config:
        return type(self)({copy.deepcopy(key): copy.deepcopy(value) for key, value in self.items()})

    def __reduce__(self) -> Any:
        return Config, (dict(self),)
