"""`sensitol mcp` by the client of the protocol's own package, over stdio."""

import json
import os
import shutil
import sys

import pytest

mcp = pytest.importorskip("mcp")
anyio = pytest.importorskip("anyio")

GAP = """
[dimensions]
bore = { nominal = 25.02, tolerance = 0.01, unit = "mm" }
shaft = { nominal = 24.98, tolerance = 0.01, unit = "mm" }
[characteristics]
gap = { formula = "bore - shaft", unit = "mm", lower = 0.02, upper = 0.06, target_yield = 0.99 }
[costs]
bore = { model = "reciprocal", a = 1.0, b = 0.20, min = 0.005, max = 0.04 }
shaft = { model = "reciprocal", a = 1.0, b = 0.10, min = 0.005, max = 0.04 }
"""
WRONG = GAP.replace("tolerance = 0.01", "tolerence = 0.01", 1)
PROGRAM = """
[model]
command = ["python3", "gap.py"]
[dimensions]
a = { nominal = 1.0, tolerance = 0.1 }
[characteristics]
y = {}
"""
#: Answers like a model, and leaves a mark that it was started.
MODEL = """
import json, sys
open("started", "w").close()
json.loads(sys.stdin.readline())
print(json.dumps({"ready": True, "name": "gap", "version": "1"}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    print(json.dumps({"id": request["id"], "y": [2 * request["x"][0]]}), flush=True)
"""


@pytest.fixture
def folder(tmp_path):
    studies = tmp_path / "studies"
    studies.mkdir()
    (studies / "gap.toml").write_text(GAP)
    (studies / "wrong.toml").write_text(WRONG)
    (studies / "program.toml").write_text(PROGRAM)
    (studies / "gap.py").write_text(MODEL)
    (tmp_path / "secret.toml").write_text(GAP)
    (tmp_path / "secret.csv").write_text("pin\n7.99\n8.01\n8.02\n7.98\n8.00\n8.01\n7.99\n8.00\n")
    return studies


def calls(folder, *asked, options=()):
    """Starts a server, calls these tools, and returns (is it an error, text, structured content) of each."""

    async def run():
        parameters = mcp.StdioServerParameters(command=sys.executable, args=["-m", "sensitol", "mcp", str(folder), *options])
        async with mcp.stdio_client(parameters) as streams, mcp.ClientSession(*streams) as session:
            await session.initialize()
            names = {tool.name for tool in (await session.list_tools()).tools}
            assert names == {"list_studies", "check", "analyze", "simulate", "allocate", "explain_warning"}
            found = []
            for tool, arguments in asked:
                answer = await session.call_tool(tool, arguments)
                text = "".join(part.text for part in answer.content)
                found.append((bool(answer.is_error), text, answer.structured_content))
            return found

    return anyio.run(run)


def test_every_tool_answers(folder):
    listed, valid, wrong, analysed, figures, sampled, allocated, explained = calls(
        folder,
        ("list_studies", {}),
        ("check", {"study": "gap.toml"}),
        ("check", {"study": "wrong.toml"}),
        ("analyze", {"study": "gap.toml", "method": "full"}),
        ("analyze", {"study": "gap.toml", "method": "full", "as_json": True}),
        ("simulate", {"study": "gap.toml", "samples": 2000}),
        ("allocate", {"study": "gap.toml"}),
        ("explain_warning", {"code": "unused-dimension"}),
    )
    assert set(listed[2]["result"]) == {"gap.toml", "wrong.toml", "program.toml"}
    assert valid[2]["valid"] and valid[2]["errors"] == []
    # The misspelt key stands in the third line of the text, which begins with an empty one.
    fault = wrong[2]["errors"][0]
    assert not wrong[2]["valid"] and fault["line"] == 3 and "tolerance" in fault["advice"]
    assert not analysed[0] and "gap" in analysed[1] and "Cpk" in analysed[1]
    # Two independent normal dimensions with tolerance 0.01 = 3 sigma: sigma of the difference is 0.01/3 sqrt(2). Rounding alone remains.
    sigma = json.loads(figures[1])["characteristics"][0]["sigma"]
    assert abs(sigma - 0.01 / 3 * 2**0.5) < 1e-12
    assert not sampled[0] and "2000" in sampled[1]
    assert not allocated[0] and "[dimensions]" in allocated[1]
    assert "formula" in explained[1] and "Look for a wrong name" in explained[1]


def test_no_study_outside_the_folder(folder):
    os.symlink(folder.parent / "secret.toml", folder / "link.toml")
    os.symlink(folder.parent, folder / "up")
    names = ["../secret.toml", str(folder.parent / "secret.toml"), "link.toml", "up/secret.toml", "studies/../../secret.toml"]
    for (failed, text, _), name in zip(calls(folder, *(("check", {"study": name}) for name in names)), names):
        assert failed and "outside the folder" in text, name


def test_no_file_of_a_study_outside_the_folder(folder):
    os.symlink(folder.parent / "secret.csv", folder / "pin.csv")
    study = '[dimensions]\npin = {{ nominal = 8.0, measured = "{}" }}\nbore = {{ nominal = 8.1, tolerance = 0.03 }}\n'
    study += '[characteristics]\nclearance = {{ formula = "bore - pin" }}\n'
    names = ["../secret.csv", str(folder.parent / "secret.csv"), "pin.csv"]
    for number, name in enumerate(names):
        (folder / f"s{number}.toml").write_text(study.format(name))
    asked = [("analyze", {"study": f"s{number}.toml"}) for number in range(len(names))]
    for (failed, text, _), name in zip(calls(folder, *asked), names):
        assert failed and "outside the folder of studies" in text and "7.99" not in text, name
    # The same study with a file of the folder is analysed: the refusals above are about the place alone.
    os.remove(folder / "pin.csv")
    shutil.copy(folder.parent / "secret.csv", folder / "pin.csv")
    ((failed, text, _),) = calls(folder, ("analyze", {"study": "s2.toml"}))
    assert not failed, text


def test_no_program_unless_allowed(folder):
    asked = ("analyze", {"study": "program.toml", "method": "full"})
    ((failed, text, _),) = calls(folder, asked)
    assert failed and "--allow-external" in text and not (folder / "started").exists()
    ((failed, text, _),) = calls(folder, asked, options=["--allow-external"])
    assert not failed and (folder / "started").exists(), text


def test_wrong_options_are_errors(folder):
    found = calls(
        folder,
        ("analyze", {"study": "gap.toml", "method": "fulll"}),
        ("simulate", {"study": "gap.toml", "samples": 10**9}),
        ("analyze", {"study": "gap.toml", "seconds": -1}),
        ("explain_warning", {"code": "unused-dimensions"}),
        ("check", {"study": "gapp.toml"}),
    )
    assert all(failed for failed, _, _ in found)
    texts = [text for _, text, _ in found]
    assert "full" in texts[0] and "10000000" in texts[1] and "seconds" in texts[2]
    assert "unused-dimension" in texts[3] and "gap.toml" in texts[4]
