"""The operating system abstraction layer (OSAL) on the simulated kernel.

It may import cfepy.rtos and what is left of it. Everything above talks to it through `Osal`.
"""

from cfepy.osal.clock import OsTime
from cfepy.osal.core import Ledger, ObjectSizes
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.osal import Osal
from cfepy.osal.volumes import Volume

__all__ = ["FileSystem", "Ledger", "ObjectSizes", "OsTime", "Osal", "Volume"]
