"""The documentation as a site: `make site` builds it in build/site. Tutorials are run while it is built."""

import os
import pathlib
import re

PROJECT = pathlib.Path(__file__).resolve().parents[2]
SHARED = pathlib.Path(os.environ.get("VANTAGE_SHARED", PROJECT.parent / "shared"))
os.environ["VANTAGE_SHARED"] = str(SHARED)
os.environ["VANTAGE_PROJECT"] = str(PROJECT)

project = "vantage"
version = re.search(r'VANTAGE_VERSION "([^"]+)"', (PROJECT / "include/vantage/version.h").read_text())[1]
copyright = "the vantage authors"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["site", "**/*.py"]
html_theme = "furo"
html_title = f"vantage {version}"

# Documents are read in the repository, too: headings have the anchors that they have there.
myst_heading_anchors = 4
myst_enable_extensions = []

nb_execution_mode = "cache"
nb_execution_cache_path = str(PROJECT / "build" / "site-cache")
nb_execution_timeout = 300
nb_execution_raise_on_error = True
# These begin with real cities: without them they are shown as they are written.
if not (SHARED / "data").is_dir():
    nb_execution_excludepatterns = [f"tutorials/{path.name}" for path in (PROJECT / "docs" / "tutorials").glob("*.md")
                                    if 'os.environ["VANTAGE_SHARED"]' in path.read_text()]

autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autoclass_content = "class"
napoleon_use_ivar = True
# Types of other packages have no pages here.
nitpicky = False


def stay_inside(app, name, source):
    """Links out of docs/ lead to files that the site does not have: their texts stay."""
    depth = name.count("/") + 1
    source[0] = re.sub(rf"\[([^\]]+)\]\((?:\.\./){{{depth}}}[^)]*\)", r"\1", source[0])


def code_in_docstrings(app, what, name, obj, options, lines):
    """Docstrings write code as Markdown does: `Scene`, two `Volume`s."""
    lines[:] = [re.sub(r"(?<!`)`([^`]+)`(?!`)(\w)?", lambda m: f"``{m[1]}``" + (f"\\ {m[2]}" if m[2] else ""), line)
                for line in lines]


def setup(app):
    app.connect("autodoc-process-docstring", code_in_docstrings)
    app.connect("source-read", stay_inside)
