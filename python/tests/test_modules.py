"""The modules of the package are in layers: none imports, directly or through others, what imports it."""

import ast
import graphlib

from conftest import PROJECT

PACKAGE = PROJECT / "python" / "vantage"

# Modules that another one may import inside a function.
LATE = {
    ("vantage._field", "vantage.fields"): "importing vantage.fields needs xarray, an optional package",
    ("vantage.__main__", "vantage.batch._cli"): "most calls of the program are none of `vantage batch`",
}


def name_of(file):
    """As it is imported: "vantage._scene"; of a package its own name."""
    parts = ["vantage", *file.relative_to(PACKAGE).with_suffix("").parts]
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {name_of(file): file for file in sorted([*PACKAGE.rglob("*.py"), PACKAGE / "_core.pyi"])}


def imported_by(node, file):
    """The modules of the package that a statement imports."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names if alias.name in FILES]
    package = ["vantage", *file.relative_to(PACKAGE).parent.parts]
    base = ".".join([*package[:len(package) + 1 - node.level], *filter(None, [node.module])]) if node.level else node.module
    modules = [f"{base}.{alias.name}" if f"{base}.{alias.name}" in FILES else base for alias in node.names]
    return [module for module in dict.fromkeys(modules) if module in FILES]


def imports():
    """(module, what it imports, whether that is inside a function), of all modules."""
    for name, file in FILES.items():
        tree = ast.parse(file.read_text())
        functions = [node for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda))]
        inside = {id(node) for function in functions for node in ast.walk(function)}
        for node in ast.walk(tree):
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                for other in imported_by(node, file):
                    yield name, other, id(node) in inside


def test_no_modules_import_each_other_in_a_circle():
    graph = {name: set() for name in FILES}
    for name, other, _ in imports():  # also those inside functions, and those for types alone
        graph[name].add(other)
    assert len(graph["vantage"]) > 10 and "vantage._scene" in graph["vantage.batch._run"]  # imports were found at all
    graphlib.TopologicalSorter(graph).prepare()  # raises CycleError, which names the modules


def test_modules_are_not_imported_inside_functions():
    late = {(name, other) for name, other, is_late in imports() if is_late}
    assert late == set(LATE)


def named_in(file):
    """The functions, classes and values of a module, without importing it."""
    named = {}
    for node in ast.parse(file.read_text()).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            named[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            named[node.target.id] = node
        elif isinstance(node, ast.Assign):
            named |= {target.id: node for target in node.targets}
    return named


def parameters_of(function):
    return [one.arg for one in function.args.posonlyargs + function.args.args + function.args.kwonlyargs]


def test_the_package_in_webassembly_has_each_name_or_says_that_it_lacks_it():
    wasm = PROJECT / "python" / "wasm" / "vantage" / "_core"
    native, there = named_in(PACKAGE / "_core.pyi"), named_in(wasm / "__init__.py")
    lacked = [key.value for key in named_in(PACKAGE / "_missing.py")["NAMES"].value.keys]
    assert set(native) == {"version", *lacked} | (set(native) & set(there))  # its __getattr__ knows the version
    assert not set(lacked) & set(there) and len(native) > 50
    for name in set(native) & set(there):
        one, other = native[name], there[name]
        pairs = [(name, one, other)] if isinstance(one, ast.FunctionDef) else []
        if isinstance(one, ast.ClassDef):
            methods = {part.name: part for part in other.body if isinstance(part, ast.FunctionDef)}
            pairs = [(f"{name}.{part.name}", part, methods[part.name]) for part in one.body
                     if isinstance(part, ast.FunctionDef) and part.name in methods and part.name != "__init__"]
        for what, function, same in pairs:
            assert parameters_of(function) == parameters_of(same), what
