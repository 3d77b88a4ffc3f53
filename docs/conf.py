"""Sphinx configuration; `make docs` builds into site/."""

import pkgutil
from pathlib import Path

import tempose

project = "Tempose"
author = "The Tempose developers"
copyright = author
release = tempose.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.viewcode", "numpydoc"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["_build"]
html_theme = "furo"
html_title = "Tempose"
html_static_path = []

autodoc_member_order = "bysource"
autodoc_typehints = "none"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False


MEMBERS = {"typing": " Progress, silent"}
"""Packages of which only some names are documented: array aliases have no signature to show."""


def write_api_pages() -> None:
    """Write one page a package: its docstring and what its ``__all__`` names."""
    folder = Path(__file__).parent / "api"
    folder.mkdir(exist_ok=True)
    names = sorted(
        module.name
        for module in pkgutil.iter_modules(tempose.__path__)
        if not module.name.startswith("_") and module.name != "cli"
    )
    for name in names:
        title = f"tempose.{name}"
        rst = f".. automodule:: {title}\n   :members:{MEMBERS.get(name, '')}"
        text = f"# {title}\n\n```{{eval-rst}}\n{rst}\n```\n"
        (folder / f"{name}.md").write_text(text, encoding="utf-8")
    for stale in set(folder.glob("*.md")) - {folder / f"{name}.md" for name in names}:
        stale.unlink()


write_api_pages()
