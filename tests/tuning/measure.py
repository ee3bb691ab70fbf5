#!/usr/bin/env python3
"""Which constant changes what: every numeric constant of the methods, their estimates and their verification, doubled and halved.

    python3 tests/tuning/measure.py        # renews tests/tuning/README.md: constants that are new or have another value
    python3 tests/tuning/measure.py --all  # all of them anew; an hour of CPU time
    python3 tests/tuning/measure.py --write # what was measured before the measurement was ended

Each constant is of a kind, which kinds.toml says: the page lists those that decide first.

The library is copied to target/tuning with its constants as variables, compiled once, and run on the functions that constants may be
tuned on (tests/data/accuracy). The functions by which errors are judged (tests/data/trust.jsonl) are not looked at: a constant that is
chosen by this table has not been chosen by them. A constant that sizes an array, or that another constant is made of, stays as it is.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KINDS = Path(__file__).with_name("kinds.toml")
PAGE = Path(__file__).with_name("README.md")
BUILD = ROOT / "target" / "tuning"
# By package: the engine, and the mathematics below it.
PACKAGES = {"src": ["analysis", "estimate", "method", "simulation", "verification"], "crates/numeric/src": ["surrogate"]}
FOLDERS = [f"{package}/{folder}" for package, folders in PACKAGES.items() for folder in folders]
DEFINITION = re.compile(
    r"^(?P<indent>\s*)(?P<public>pub(?:\([a-z]+\))? )?const (?P<name>[A-Z][A-Z_0-9]*): (?P<type>f64|usize|u64|u32|i32) =\s+(?P<value>[^;]+);",
    re.M,
)
# A row whose measurement was ended before its turn came: the next run measures it.
OPEN = "not measured yet"
# The further runs were ended before its turn came.
HALF = "nothing in the first runs"
# Of these kinds all runs are made.
FURTHER = ["decision", "statistic", "guard"]
# Noise below which two results are the same: sums in another order.
SAME = 1e-9


def constants():
    """Every constant: file, name, type, value as written, and what its comment says."""
    for folder in FOLDERS:
        package = next(package for package in PACKAGES if folder.startswith(f"{package}/"))
        for path in sorted((ROOT / folder).rglob("*.rs")):
            text = path.read_text().split("#[cfg(test)]\nmod tests {")[0]
            if path.name == "tests.rs":
                continue
            for found in DEFINITION.finditer(text):
                yield {
                    "file": str(path.relative_to(ROOT / package)),
                    "path": str(path.relative_to(ROOT)),
                    "name": found["name"],
                    "type": found["type"],
                    "value": " ".join(found["value"].split()),
                    "public": bool(found["public"]),
                    "meaning": meaning(text[: found.start()], found["indent"]),
                }


def meaning(before, indent):
    """The comment above: constants that share one stand below each other."""
    lines, comment = before.rstrip("\n").split("\n"), []
    while lines and DEFINITION.match(lines[-1] + "\n"):
        lines.pop()
    while lines and lines[-1].strip().startswith("//"):
        comment.insert(0, lines.pop().strip().lstrip("/").strip())
    # Links of the library's documentation lead nowhere on a page.
    text = re.sub(r"\[([^\]]+)\]\([^)]*\)", r"\1", " ".join(comment))
    return re.sub(r"\[(`[^`]+`)\]", r"\1", text)


def scaled_copy(fixed):
    """The sources with every constant that is not fixed as a function of the environment."""
    source = BUILD / "tree"
    shutil.rmtree(source, ignore_errors=True)
    for folder in ["src", "crates"]:
        shutil.copytree(ROOT / folder, source / folder, ignore=shutil.ignore_patterns("tests", "benches"))
    manifest = (ROOT / "Cargo.toml").read_text()
    manifest = re.sub(r"members = \[[^\]]*\]", 'members = ["crates/*"]', manifest)
    manifest = re.sub(r"\[\[bench\]\]\n[^\[]*", "", manifest)
    manifest = manifest.replace('missing_docs = "deny"', 'missing_docs = "allow"')
    lints = '[workspace.lints.rust]\nnon_snake_case = "allow"\nunused = { level = "allow", priority = -1 }'
    manifest = manifest.replace("[workspace.lints.rust]", lints)
    (source / "Cargo.toml").write_text(manifest)
    for command in (source / "crates").glob("*/Cargo.toml"):
        command.write_text(re.sub(r"\[\[bench\]\]\n[^\[]*", "", command.read_text()))
    shutil.copy(ROOT / "Cargo.lock", source / "Cargo.lock")
    shutil.copy(ROOT / "README.md", source / "README.md")
    (source / "examples").mkdir(exist_ok=True)
    shutil.copy(Path(__file__).with_name("driver.rs"), source / "examples" / "driver.rs")
    library = source / "crates" / "numeric" / "src" / "lib.rs"
    library.write_text(library.read_text() + TUNABLE)
    for one in constants():
        if key(one) in fixed:
            continue
        path = source / one["path"]
        text = path.read_text()

        def variable(found):
            if found["name"] != one["name"]:
                return found[0]
            home = "crate" if one["path"].startswith("crates/numeric/") else "sensitol_numeric"
            of = f'{home}::tunable("{key(one)}", ({found["value"]}) as f64)'
            whole = found["type"] != "f64"
            of = f"{of}.round().max(1.0)" if whole else of
            return (
                f'{found["indent"]}{found["public"] or ""}fn {found["name"]}() -> {found["type"]} {{ '
                f"static V: std::sync::OnceLock<f64> = std::sync::OnceLock::new(); *V.get_or_init(|| {of}) as {found['type']} }}"
            )

        text = DEFINITION.sub(variable, text)
        path.write_text(called(text, one["name"]))
        if one["public"]:
            for other in [*(source / "src").rglob("*.rs"), *(source / "crates").rglob("*.rs")]:
                if other != path:
                    text = other.read_text()
                    if imports(text, one):
                        other.write_text(called(text, one["name"]))
    return source


def imports(text, one):
    """Whether a file imports a constant: from its file, or as its folder passes it on."""
    places = {Path(one["file"]).stem, Path(one["file"]).parent.name}
    uses = re.findall(rf"\buse ([^;]*\b{one['name']}\b[^;]*);", text)
    return any(re.search(rf"\b({'|'.join(places)})::", use) for use in uses)


def called(text, name):
    """Uses of a constant as calls, but for imports, comments and texts."""
    out, importing = [], False
    for line in text.split("\n"):
        bare = line.strip()
        if re.match(r"(pub(\([a-z]+\))? )?use ", bare):
            importing = True
        if not importing and not bare.startswith("//") and f"fn {name}()" not in line:
            line = re.sub(rf"(?<![\w\"'`])(?<!::){name}\b(?!\(|::|`)", f"{name}()", line)
            line = re.sub(rf"\b(Self|super|[a-z_]+)::{name}\b(?!\(|::)", rf"\1::{name}()", line)
        if importing and ";" in line:
            importing = False
        out.append(line)
    return "\n".join(out)


TUNABLE = """
/// A constant, scaled where the environment asks for it.
pub fn tunable(name: &str, value: f64) -> f64 {
    static ASKED: std::sync::OnceLock<Option<(String, f64)>> = std::sync::OnceLock::new();
    let asked = ASKED.get_or_init(|| {
        let (name, factor) = std::env::var("SENSITOL_TUNE").ok()?.rsplit_once('=').map(|(n, f)| (n.to_owned(), f.to_owned()))?;
        Some((name, factor.parse().ok()?))
    });
    asked.as_ref().filter(|(asked, _)| asked == name).map_or(value, |(_, factor)| value * factor)
}
"""


def key(one):
    return f"{one['file']}:{one['name']}"


def compiled():
    """The driver, and which constants cannot vary: those on a line that does not compile as a call."""
    # Those of the run before spare some builds.
    known = BUILD / "fixed.json"
    fixed = set(json.loads(known.read_text())) & {key(one) for one in constants()} if known.exists() else set()
    command = ["cargo", "build", "--release", "-p", "sensitol", "--example", "driver"]
    environment = {**os.environ, "CARGO_TARGET_DIR": str(BUILD / "target")}
    for _ in range(30):
        source = scaled_copy(fixed)
        ran = subprocess.run([*command, "--message-format=json"], cwd=source, env=environment, capture_output=True, text=True)
        if ran.returncode == 0:
            known.write_text(json.dumps(sorted(fixed)))
            return BUILD / "target" / "release" / "examples" / "driver", fixed
        found = set()
        for line in ran.stdout.splitlines():
            message = json.loads(line).get("message") if line.startswith("{") else None
            if not message or message.get("level") != "error":
                continue
            for span in message["spans"]:
                file = span["file_name"]
                for text in span["text"]:
                    for one in constants():
                        of = one["path"] == file or one["public"]
                        if of and re.search(rf"\b{one['name']}\b", text["text"]) and key(one) not in fixed:
                            found.add(key(one))
        if not found:
            sys.exit(ran.stdout[-3000:] + ran.stderr[-3000:])
        print(f"fixed: {sorted(found)}", file=sys.stderr)
        fixed |= found
    sys.exit("no end of constants that cannot vary")


def run(driver, tuned=None, further=False):
    """What the functions come to: by function and way of running."""
    environment = dict(os.environ)
    if tuned:
        environment["SENSITOL_TUNE"] = tuned
    try:
        ran = subprocess.run(
            [driver, ROOT / "tests" / "data" / "accuracy", "further" if further else "first"],
            env=environment,
            capture_output=True,
            text=True,
            timeout=600,
        )
    except subprocess.TimeoutExpired:
        return None
    if ran.returncode != 0:
        return None
    lines = [json.loads(line) for line in ran.stdout.splitlines()]
    return {(line["name"], line["kind"]): line for line in lines}


def figures(result):
    """How many figures have an error, and how many of these are within three of it."""
    known = covered = 0
    for line in result.values():
        for number, (value, off, error) in enumerate(line["figures"]):
            if off is None or error is None:
                continue
            floor = 1e-7 * [line["sigma"], line["sigma"], 10.0, 100.0][number]
            known += 1
            covered += off <= 3.0 * error + floor
    return known, covered


def same(a, b):
    if a is None or b is None:
        return a is b
    return abs(a - b) <= SAME * max(abs(a), abs(b), 1e-12)


def effect(before, after):
    """What is different, in few words."""
    if after is None:
        return "does not end in ten minutes, or fails"
    changed = 0
    for of, line in before.items():
        other = after[of]
        alike = line["evaluations"] == other["evaluations"] and line["warnings"] == other["warnings"]
        alike = alike and all(same(*pair) for a, b in zip(line["figures"], other["figures"]) for pair in zip(a, b))
        changed += not alike
    if not changed:
        return "nothing"
    said = [f"{changed} of {len(before)}"]
    total = [sum(line["evaluations"] for line in of.values() if "sampled" not in line["kind"]) for of in (before, after)]
    if total[0] != total[1]:
        said.append(f"evaluations {100.0 * (total[1] / total[0] - 1.0):+.1f} %")
    (known, covered), (now_known, now_covered) = figures(before), figures(after)
    if known - covered != now_known - now_covered:
        said.append(f"not covered {now_known - now_covered} (now {known - covered})")
    warned = [sum(len(line["warnings"]) for line in of.values()) for of in (before, after)]
    if warned[0] != warned[1]:
        said.append(f"warnings {warned[1]} (now {warned[0]})")
    return ", ".join(said)


def both(driver, before, one, factor):
    """What a factor changes: in the first runs, and for what decides, where it is nothing there, in the further ones."""
    tuned = f"{key(one)}={factor}"
    found = effect(before["first"], run(driver, tuned))
    if found != "nothing" or kinds()[one["file"]][one["name"]] not in FURTHER:
        return found
    found = effect(before["further"], run(driver, tuned, further=True))
    return found if found == "nothing" else f"further: {found}"


def kinds():
    """The kind of every constant, by file and name."""
    return tomllib.loads(KINDS.read_text())["constants"]


def written(rows, first, further):
    known, covered = figures(first)
    total = sum(line["evaluations"] for line in first.values() if "sampled" not in line["kind"])
    names = {name for name, _ in first}
    meanings = tomllib.loads(KINDS.read_text())["kinds"]
    by_kind = {kind: [row for row in rows if kinds()[row[0]["file"]][row[0]["name"]] == kind] for kind in meanings}
    still = lambda row: all(cell in ("nothing", HALF) for cell in row[1:])
    text = f"""# Constants, and what they do

Written by [measure.py](measure.py), which doubles and halves every numeric constant of
{", ".join(f"`{folder}`" for folder in FOLDERS[:-1])} and `{FOLDERS[-1]}` and runs the {len(names)} functions that constants may be tuned
on ([docs/accuracy.md](../../docs/accuracy.md)) of at most 20 dimensions, all but `saturating-3`, in four ways: `auto` of a cheap model, `full` with check points,
`auto` without any verification at 1 % and at 0.1 %. The functions by which errors are judged are not among them.

As they are: {len(first)} runs, {total} evaluations of models that cost something, {known} figures with an estimated error, {known - covered} of
them more than three estimates off. "3 of {len(first)}" says how many runs give another number, an error or a warning. Where a constant of
the kinds {", ".join(f"`{kind}`" for kind in FURTHER)} changes nothing there, {len(further)} further runs follow, and "further: 3 of {len(further)}" is said of them: of a costly model with a
budget from which it may be sampled, of `full` without verification, and of functions of 21 to 60 dimensions. "Nothing" is
said of guards against what these functions do not have (poles, overflow, correlated inputs), and of constants that a doubling leaves on the
same side of everything; after "nothing in the first runs" the further runs are still to be made. "Fixed" sizes an array, or other constants are made of it. A row was measured when its constant last changed; `--all`
measures all rows anew. [A test](../house/tuning.rs) holds that every constant has its row and its kind, which
[kinds.toml](kinds.toml) says.

| kind | meaning | constants | change nothing |
|---|---|--:|--:|
"""
    for kind, meaning in meanings.items():
        own = by_kind[kind]
        text += f"| [{kind}](#{kind}) | {meaning} | {len(own)} | {sum(map(still, own))} |\n"
    text += f"| all | | {len(rows)} | {sum(map(still, rows))} |\n\n"
    for kind, own in by_kind.items():
        text += f"## {kind}\n\n| file | constant | value | meaning | halved | doubled |\n|---|---|---|---|---|---|\n"
        for one, half, double in own:
            named = f"| `{one['file']}` | `{one['name']}` | `{cell(one['value'])}` "
            text += f"{named}| {cell(one['meaning']) or '-'} | {half} | {double} |\n"
        text += "\n"
    PAGE.write_text(text.rstrip("\n") + "\n")


def cell(text):
    return text.replace("|", "\\|")


def measured():
    """The effects on the page, by file, name and value."""
    rows = {}
    for line in PAGE.read_text().splitlines() if PAGE.exists() and "--all" not in sys.argv else []:
        found = re.match(
            r"\| `(?P<file>[\w/.]+)` \| `(?P<name>\w+)` \| `(?P<value>.*?)` \| .* \| (?P<half>[^|]*) \| (?P<double>[^|]*) \|$", line
        )
        effects = [found["half"], found["double"]] if found else []
        open_ = {OPEN, "fixed"} if "--write" in sys.argv else {OPEN, HALF, "fixed"}
        if found and not open_ & set(effects):
            rows[found["file"], found["name"], found["value"]] = effects
    return rows


def main():
    driver, fixed = compiled()
    # As they were compiled: sources may change meanwhile.
    every = list(constants())
    before = {"first": run(driver), "further": run(driver, further=True)}
    # A measurement that was ended goes on where it was, unless the driver is another one.
    kept = BUILD / "effects.json"
    effects = json.loads(kept.read_text()) if kept.exists() and kept.stat().st_mtime > driver.stat().st_mtime else {}
    known = measured()
    for one in every:
        row = known.get((one["file"], one["name"], cell(one["value"])))
        if row and key(one) not in fixed:
            effects.setdefault(key(one), row)
    for one in every:
        if key(one) in fixed or key(one) in effects or "--write" in sys.argv:
            continue
        effects[key(one)] = [both(driver, before, one, factor) for factor in (0.5, 2.0)]
        print(f"{key(one)}: {' | '.join(effects[key(one)])}", file=sys.stderr, flush=True)
        kept.write_text(json.dumps(effects))
    rest = lambda one: ["fixed", "fixed"] if key(one) in fixed else [OPEN, OPEN]
    written([(one, *effects.get(key(one), rest(one))) for one in every], before["first"], before["further"])


main()
