"""The module's names are those of its stub, and each is documented."""
import ast
import os
from pathlib import Path

import maploop

STUB = Path(os.environ["MAPLOOP_SOURCE"]) / "tools/python/__init__.pyi"
CLASSES = {node.name: node for node in ast.parse(STUB.read_text()).body if isinstance(node, ast.ClassDef)}


def members(name):
    """The public names of a class of the stub, its bases' included."""
    node = CLASSES[name]
    own = {f.name for f in node.body if isinstance(f, ast.FunctionDef)}
    return own.union(*(members(base.id) for base in node.bases))


def public(names):
    return {n for n in names if not n.startswith("_")}


def test_the_stub_has_the_names_of_the_module():
    nodes = ast.parse(STUB.read_text()).body
    stub = set(CLASSES) | {n.name for n in nodes if isinstance(n, ast.FunctionDef)}
    stub |= {n.target.id for n in nodes if isinstance(n, ast.AnnAssign)}
    assert public(stub) == public(dir(maploop))


def test_the_stub_has_the_members_of_each_class():
    for name in public(CLASSES):
        assert public(members(name)) == public(dir(getattr(maploop, name))), name


def test_everything_has_a_docstring():
    for name in public(dir(maploop)):
        thing = getattr(maploop, name)
        if isinstance(thing, type) or callable(thing):
            assert thing.__doc__, name
    assert "nanoseconds" in maploop.__doc__


def test_the_version_is_the_projects():
    cmake = (Path(os.environ["MAPLOOP_SOURCE"]) / "CMakeLists.txt").read_text()
    assert f"project(maploop VERSION {maploop.__version__} " in cmake
