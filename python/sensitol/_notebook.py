"""Report pages in notebooks."""

from __future__ import annotations

import html

#: The frame's height in pixels; it can be pulled larger.
HEIGHT = 600


def frame(page: str) -> str:
    """A page in a frame of its own: neither its style nor its script reaches the notebook, nor the other way round."""
    return (
        f'<iframe srcdoc="{html.escape(page, quote=True)}" sandbox="allow-scripts allow-downloads" '
        f'style="width:100%;height:{HEIGHT}px;border:0;resize:vertical;overflow:auto" title="report of sensitol"></iframe>'
    )
