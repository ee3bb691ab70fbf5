"""The command of the package, as another process runs it."""

import os
import shutil
import subprocess
import sys

import pytest

import sensitol as st


def run(*words, folder=None):
    done = subprocess.run([sys.executable, "-m", "sensitol", *words], cwd=folder, text=True, capture_output=True)
    return done.returncode, done.stdout, done.stderr


def test_the_module_is_the_command():
    assert run("--version") == (0, f"sensitol {st.__version__}\n", "")
    code, out, told = run("analyse")
    assert code == 2 and out == "" and "analyze" in told


def test_an_example_is_copied_and_analysed(tmp_path):
    code, told, _ = run("examples", "copy", "engine-balance", folder=tmp_path)
    assert code == 0 and "engine-balance/study.toml" in told
    code, report, _ = run("analyze", "engine-balance/study.toml", folder=tmp_path)
    # The nominal force that the paper prints, to six digits: 12556.9373 N.
    assert code == 0 and "12556.94" in report
    # The nominal force as the paper prints it, to half of its last digit.
    result = st.read(tmp_path / "engine-balance" / "exact-speed.toml").analyze("rss")
    assert abs(result["F"].nominal - 12556.9373) < 5e-5


def test_the_import_loads_neither_the_engine_nor_numpy():
    code = "import sensitol, sys; print([name for name in ('numpy', 'sensitol._core', 'json', 'mcp') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-I", "-c", code], text=True, capture_output=True)
    assert done.stdout.strip() == "[]", done.stderr


@pytest.mark.parametrize("words", [["mcp"], ["mcp", "nowhere"], ["mcp", ".", "--allow-everything"]])
def test_a_server_that_cannot_start_says_why(words, tmp_path):
    code, out, told = run(*words, folder=tmp_path)
    assert code == 2 and out == "" and told


def test_the_page_of_the_package_is_found(tmp_path):
    # The program accepts a page by its marks; the one here is none, and the message names the file of the package.
    package = tmp_path / "sensitol"
    shutil.copytree(os.path.dirname(st.__file__), package)
    (package / "workbench.html").write_text("no page")
    done = subprocess.run(
        [sys.executable, "-c", "from sensitol._cli import main; main()", "workbench"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        text=True,
        capture_output=True,
    )
    assert done.returncode == 2 and "sensitol/workbench.html is not a page" in done.stderr.replace(os.sep, "/")
