"""What documents show is what the package does: every block of Python in them runs, every session prints what it shows."""

import doctest
import os
import re
import sys

import pytest
from conftest import REPOSITORY

import sensitol as st

PAGES = ["README.md", "python/README.md", "docs/how-to/python.md"]


@pytest.mark.parametrize("page", PAGES)
def test_blocks_of_a_page(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with open(os.path.join(REPOSITORY, page), encoding="utf-8") as file:
        text = file.read()
    names = {"__name__": "page"}
    blocks = re.findall(r"^```(python|pycon)\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)
    assert blocks
    for kind, block in blocks:
        if kind == "python":
            exec(compile(block, page, "exec"), names)
            continue
        test = doctest.DocTestParser().get_doctest(block, names, page, page, 0)
        test.globs = names
        told = []
        doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(
            test, out=told.append, clear_globs=False
        )
        assert not told, "".join(told)


@pytest.mark.parametrize("documented", [st, st.model, st.Study])
def test_examples_of_the_documentation(documented):
    tests = [test for test in doctest.DocTestFinder().find(documented, "sensitol", module=False) if test.examples]
    assert tests
    for test in tests:
        test.globs.update(vars(st), st=st)
        assert doctest.DocTestRunner().run(test).failed == 0


def test_every_public_name_is_documented_and_has_a_home():
    for name in st.__all__:
        value = getattr(st, name)
        assert value.__doc__, name
        assert name in dir(st)
    with pytest.raises(AttributeError, match="module 'sensitol' has no attribute 'analyse'"):
        st.analyse


def test_a_notebook_runs_and_has_the_page(tmp_path):
    nbclient = pytest.importorskip(
        "nbclient", reason="skipped: nbclient is not installed; install with: pip install nbclient ipykernel"
    )
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel", reason="skipped: ipykernel is not installed; install with: pip install ipykernel")
    path = os.path.join(REPOSITORY, "python/examples/shaft-and-bore.ipynb")
    notebook = nbformat.read(path, as_version=4)
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    client = nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}})
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")
    client.execute()
    shown = [output["data"] for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs if "data" in output]
    pages = [data["text/html"] for data in shown if "text/html" in data and "<iframe" in data["text/html"]]
    assert pages and 'type="range"' in pages[0].replace("&quot;", '"')
    # tests/browser/notebook.mjs opens it.
    kept = os.environ.get("SENSITOL_NOTEBOOK_PAGE")
    if kept:
        with open(kept, "w", encoding="utf-8") as file:
            file.write("<!DOCTYPE html>\n<meta charset=\"utf-8\"><title>notebook</title>\n" + pages[0])
    # A wrong study is shown as its error, and the notebook goes on.
    errors = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs if output.output_type == "error"]
    assert [error.ename for error in errors] == ["StudyError"]
    assert sys.version_info >= (3, 9)
