"""Turns a Python function of named dimensions into a model for sensitol.

    from sensitol_adapter import adapter

    @adapter
    def gap(a, b):
        return a - b

    if __name__ == "__main__":
        gap.serve()

See PROTOCOL.md in the folder above for what goes over the wire.
"""

from ._adapter import Adapter, NoValue, adapter
from ._declared import Declaration, Settings, load

__all__ = ["Adapter", "Declaration", "NoValue", "Settings", "adapter", "load"]
__version__ = "0.1.0"
