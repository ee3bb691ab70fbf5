"""Writes sensitol/_reports.py, the types of results, from the JSON Schema of reports.

    sensitol schema --report | python tools/reports.py > sensitol/_reports.py
"""

from __future__ import annotations

import json
import keyword
import re
import sys
import textwrap

#: Results, by the report that they are.
ROOTS = {
    "Report": "AnalysisResult",
    "SimulationReport": "SimulationResult",
    "RareReport": "RareResult",
    "CompareReport": "ComparisonResult",
    "SweepReport": "SweepResult",
    "AllocationReport": "AllocationResult",
}
#: Names for readers, where the schema has those of the engine.
NAMES = {
    "CharacteristicAnalysis": "CharacteristicResult",
    "SurfaceShares": "SurfaceLaw",
    "SurrogateControl": "Control",
    "Errors": "ErrorVsReference",
    "SweptReport": "SweptCharacteristic",
    "SweptPointReport": "SweptPoint",
    "ComparedReport": "ComparedCharacteristic",
    "MethodReport": "ComparedMethod",
    "DimensionReport": "DimensionResult",
    "AllocatedReport": "AllocatedTolerance",
    "WarningReport": "ReportedWarning",
}
HEAD = '''"""The types of results, one class for each object of a report. Made from the schema of reports by tools/reports.py."""

from __future__ import annotations

from typing import Any, Dict, List, Literal, Optional, Tuple, Union

from ._records import Fitted, Record, Result

'''


def name_of(definition: str) -> str:
    return ROOTS.get(definition) or NAMES.get(definition) or definition.removesuffix("Shape").removesuffix("Report")


class Writer:
    def __init__(self, definitions: dict) -> None:
        self.definitions = definitions
        self.classes: dict[str, str] = {}
        self.properties: dict[str, list[str]] = {}
        self.inner: dict[str, dict[str, tuple[str, str]]] = {}

    def type(self, schema: dict, hint: str) -> tuple[str, str]:
        """The annotation of a value, and the class of the objects within."""
        if "$ref" in schema:
            definition = schema["$ref"].rsplit("/", 1)[1]
            # The engine's generic types have a number or none, whichever came first: they are named by their place.
            generic = re.fullmatch(r"Of(Characteristic|Dimension)\d*|\w+\d", definition) or definition == "BeforeAfter"
            return self.type(self.definitions[definition], hint if generic else name_of(definition))
        options = schema.get("anyOf") or schema.get("oneOf")
        if options:
            return self.union(schema, options, hint)
        if "const" in schema:
            return f"Literal[{schema['const']!r}]", ""
        if "enum" in schema:
            return f"Literal[{', '.join(repr(value) for value in schema['enum'])}]", ""
        kind = schema.get("type")
        if isinstance(kind, list):
            rest = [one for one in kind if one != "null"]
            inner = self.type({**schema, "type": rest[0]}, hint) if len(rest) == 1 else ("Any", "")
            return (f"Optional[{inner[0]}]", inner[1]) if inner[0] != "Any" else inner
        if kind == "array":
            if "prefixItems" in schema:
                parts = [self.type(part, hint) for part in schema["prefixItems"]]
                return f"Tuple[{', '.join(part[0] for part in parts)}]", next((p[1] for p in parts if p[1]), "")
            inner = self.type(schema.get("items", {}), hint)
            return f"List[{inner[0]}]", inner[1]
        if kind == "object" or "properties" in schema:
            if schema.get("properties"):
                return self.record(schema, hint), hint
            extra = schema.get("additionalProperties")
            inner = self.type(extra, hint) if isinstance(extra, dict) and extra else ("Any", "")
            return f"Dict[str, {inner[0]}]", ""
        plain = {"string": "str", "integer": "int", "number": "float", "boolean": "bool", "null": "None"}
        return plain.get(kind, "Any"), ""

    def union(self, schema: dict, options: list, hint: str) -> tuple[str, str]:
        # A null beside one other thing; words; tables of which each says what it is; or any of these.
        nullable = any(one.get("type") == "null" for one in options)
        options = [one for one in options if one.get("type") != "null"]
        words = [one["const"] for one in options if "const" in one]
        words += [word for one in options if "enum" in one for word in one["enum"]]
        rest = [one for one in options if "const" not in one and "enum" not in one]
        tables = [one for one in rest if "properties" in one]
        rest = [one for one in rest if "properties" not in one]
        parts, inner = [], ""
        if words:
            parts.append(f"Literal[{', '.join(repr(word) for word in words)}]")
        if tables:
            merged: dict = {"properties": {}, "description": schema.get("description", "")}
            everywhere = set.intersection(*(set(one["properties"]) for one in tables))
            for one in tables:
                for key, value in one["properties"].items():
                    known = merged["properties"].get(key)
                    if known is not None and "const" in value and ("const" in known or "enum" in known):
                        values = known.get("enum", [known.get("const")]) + [value["const"]]
                        merged["properties"][key] = {"enum": list(dict.fromkeys(values))}
                    elif known is None:
                        merged["properties"][key] = dict(value)
            merged["sometimes"] = [key for key in merged["properties"] if key not in everywhere]
            own = schema.get("properties", {})
            merged["properties"] = {**own, **merged["properties"]}
            parts.append(self.record(merged, hint))
            inner = hint
        for one in rest:
            part = self.type(one, hint)
            parts.append(part[0])
            inner = inner or part[1]
        parts = list(dict.fromkeys(parts))
        if "Any" in parts or not parts:
            return "Any", inner
        joined = parts[0] if len(parts) == 1 else f"Union[{', '.join(parts)}]"
        return (f"Optional[{joined}]" if nullable else joined), inner

    def record(self, schema: dict, name: str) -> str:
        if name in self.classes:
            if self.properties[name] != list(schema["properties"]):
                raise SystemExit(f"two objects of the schema are called {name}: name one of them in NAMES")
            return name
        self.properties[name] = list(schema["properties"])
        self.classes[name] = ""
        self.inner[name] = {}
        base = "Result" if name in ROOTS.values() else "Fitted" if name == "CharacteristicResult" else "Record"
        lines = [f"class {name}({base}):", '    """' + said(schema.get("description", name)) + '"""', ""]
        sometimes = set(schema.get("sometimes", ()))
        required = schema.get("required")
        items = ""
        for key, value in schema["properties"].items():
            annotation, inner = self.type(value, name + key.title().replace("_", ""))
            missing = key in sometimes or (required is not None and key not in required)
            if missing and annotation != "Any" and not annotation.startswith("Optional"):
                annotation = f"Optional[{annotation}]"
            field = key + "_" if keyword.iskeyword(key) else key
            lines.append(f"    {field}: {annotation}")
            description = value.get("description")
            if description:
                lines.append('    """' + said(description) + '"""')
            if inner:
                self.inner[name][field] = inner
            if key == "characteristics" and base == "Result":
                items = inner
        if items:
            lines += ["", f"    def __getitem__(self, name: str) -> {items}:", '        """The characteristic of this name."""']
            lines += ["        found: " + items + " = self._named(name)", "        return found"]
        self.classes[name] = "\n".join(lines)
        return name


def said(text: str) -> str:
    text = re.sub(r"```.*?```", "", text, flags=re.DOTALL)  # examples are those of Rust
    text = re.sub(r"\b[Nn]ull\b", "None", text)  # the schema has the words of JSON
    text = " ".join(text.split()).replace("\\", "\\\\").replace('"""', "'''")
    text = text if not text.endswith('"') else text + " "
    lines = textwrap.wrap(text, 110)
    return ("\n    ".join(lines)) + ("\n    " if len(lines) > 1 else "")


def main() -> None:
    writer = Writer(json.load(sys.stdin)["$defs"])
    for root in ROOTS:
        writer.type({"$ref": f"#/$defs/{root}"}, root)
    out = HEAD
    out += "\n\n\n".join(writer.classes[name] for name in sorted(writer.classes)) + "\n\n\n"
    out += "#: The classes of the objects within each.\n_INNER: Dict[str, Dict[str, type]] = {\n"
    for name in sorted(writer.inner):
        if writer.inner[name]:
            fields = ", ".join(f'"{field}": {inner}' for field, inner in writer.inner[name].items())
            out += f'    "{name}": {{{fields}}},\n'
    out += "}\n\nfor _name, _fields in _INNER.items():\n    globals()[_name]._inner = _fields\n"
    sys.stdout.write(out)


if __name__ == "__main__":
    main()
