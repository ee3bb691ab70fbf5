"""Studies as TOML."""

from __future__ import annotations

import json
import re
from typing import Any, Mapping

#: Sections whose entries stand in a line each.
LINES = ("dimensions", "characteristics", "constants", "formulas", "unknowns", "equations", "loops", "parts", "joints", "costs")


def text(study: Mapping[str, Any]) -> str:
    """A study as the text of a TOML file."""
    plain = [f"{_key(key)} = {_value(value)}" for key, value in study.items() if not isinstance(value, Mapping) and key != "correlation"]
    parts = ["\n".join(plain)] if plain else []
    for section, value in study.items():
        if isinstance(value, Mapping) and value:
            lines = [f"[{section}]"] + [f"{_key(key)} = {_value(one)}" for key, one in value.items()]
            parts.append("\n".join(lines))
    for pair in study.get("correlation", ()):
        parts.append("[[correlation]]\n" + "\n".join(f"{_key(key)} = {_value(one)}" for key, one in pair.items()))
    return "\n\n".join(parts) + "\n"


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key, ensure_ascii=False)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(one)}" for key, one in value.items()) + " }" if value else "{}"
    return "[" + ", ".join(_value(one) for one in value) + "]"
