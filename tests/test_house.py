"""The structure of the house: floors, lazy packages, documented public names."""

import ast
import importlib
import inspect
import pkgutil
import re
import subprocess
import sys

import pytest

import swaystride
from import_graph import REPOSITORY, SOURCE, dependencies, imported_modules, module_name

FLOORS = {
    "io": 1,
    "signals": 2,
    "stats": 2,
    "presentation": 2,
    "sway": 3,
    "gait": 3,
    "erkf": 3,
    "mocap": 3,
    "simulate": 4,
    "studies": 5,
    "validation": 5,
    "report": 6,
}
FILES = sorted((SOURCE / "swaystride").rglob("*.py"))
MODULES = [
    name
    for _, name, _ in pkgutil.walk_packages(swaystride.__path__, "swaystride.")
    if not name.rsplit(".", 1)[-1].startswith("_")
]


def room_of(module: str) -> str:
    """Room of a module; studies are rooms of their own, so that they cannot lean on each other."""
    parts = module.split(".")
    if len(parts) > 2 and parts[1] == "studies":
        return f"studies.{parts[2]}"
    return parts[1] if len(parts) > 1 and parts[1] in FLOORS else ""


def floor_of(module: str) -> int:
    return FLOORS.get(room_of(module).split(".")[0], 0)


def test_every_folder_of_the_library_has_a_floor():
    rooms = {path.name for path in (SOURCE / "swaystride").iterdir() if path.is_dir()}
    assert rooms - {"__pycache__"} == set(FLOORS)


@pytest.mark.parametrize("file", FILES, ids=module_name)
def test_a_module_imports_only_from_floors_below(file):
    module = module_name(file)
    for imported in imported_modules(file):
        if room_of(imported) == room_of(module):
            continue
        assert floor_of(imported) < floor_of(module), f"{module} imports {imported}"


@pytest.mark.parametrize("file", FILES, ids=module_name)
def test_imports_name_submodules_never_lazy_packages(file):
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module in {
            f"swaystride.{room}" for room in FLOORS
        }:
            names = {alias.name for alias in node.names}
            package = SOURCE.joinpath(*node.module.split("."))
            assert all((package / f"{name}.py").exists() for name in names), ast.unparse(node)


def test_the_import_graph_sees_what_python_imports():
    """The closure computed from the text holds every module that is really loaded."""
    script = REPOSITORY / "scripts" / "standing_metrics.py"
    probe = (
        "import runpy, sys; runpy.run_path(sys.argv[1]); "
        "print(*(m.__file__ for n, m in sys.modules.items() if n.startswith('swaystride')))"
    )
    loaded = subprocess.run(
        [sys.executable, "-c", probe, str(script)],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(SOURCE)},
    ).stdout.split()
    assert set(loaded) <= {str(path) for path in dependencies(script)}
    assert len(loaded) > 5


def test_a_study_does_not_depend_on_another():
    for file in FILES:
        own = room_of(module_name(file))
        if own.startswith("studies."):
            others = {room_of(m) for m in imported_modules(file)} - {own, ""}
            assert not {room for room in others if room.startswith("studies.")}


def public_members(module):
    for name, member in vars(module).items():
        if name.startswith("_") or getattr(member, "__module__", None) != module.__name__:
            continue
        if inspect.isfunction(member) or inspect.isclass(member):
            yield name, member


@pytest.mark.parametrize("name", MODULES)
def test_public_names_are_documented(name):
    module = importlib.import_module(name)
    assert module.__doc__
    for member_name, member in public_members(module):
        doc = inspect.getdoc(member) or ""
        assert doc, f"{name}.{member_name} has no docstring"
        if inspect.isfunction(member):
            for parameter in inspect.signature(member).parameters:
                described = re.search(rf"(^|[\s,*`]){parameter}\b", doc)
                assert described, f"{name}.{member_name}: parameter {parameter} is not described"


@pytest.mark.parametrize(
    "package",
    [
        "swaystride.io",
        "swaystride.stats",
        "swaystride.sway",
        "swaystride.gait",
        "swaystride.erkf",
        "swaystride.mocap",
    ],
)
def test_lazy_exports_resolve_and_cost_nothing(package):
    module = importlib.import_module(package)
    for name in module.__all__:
        assert callable(getattr(module, name))
    with pytest.raises(AttributeError, match="no attribute 'absent'"):
        _ = module.absent


def test_importing_the_package_loads_no_heavy_library():
    probe = "import sys, swaystride.sway, swaystride.gait, swaystride.erkf, swaystride.mocap, swaystride.stats, swaystride.io; print('numpy' in sys.modules)"
    answer = subprocess.run(
        [sys.executable, "-c", probe],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(SOURCE)},
    )
    assert answer.stdout.strip() == "False"


def test_no_file_is_a_grab_bag_or_too_long():
    for file in FILES:
        assert file.stem not in {"utils", "helpers", "common", "misc", "tools"}
        lines = len(file.read_text(encoding="utf-8").splitlines())
        assert lines <= 400, f"{file.name} has {lines} lines"
