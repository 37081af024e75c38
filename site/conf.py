"""How Sphinx makes the site (`make site`): the pages are the repository's own Markdown files, as they are."""
import os
import pathlib
import sys

ROOT = pathlib.Path(os.environ["SITE_ROOT"])
sys.path[:0] = [str(ROOT / "site"), str(ROOT / "python")]

project = "uncross"
author = "uncross contributors"
copyright = "uncross contributors, BSD-3-Clause"
version = release = os.environ["SITE_VERSION"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "repository", "scene_keys", "header", "docstrings", "formulas", "theme"]
include_patterns = ["*.md", "docs/**.md", "interface/*.md", "**/README.md"]
exclude_patterns = ["build", "**/target", "**/node_modules", "docs/paper"]
myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath", "colon_fence"]
nitpicky = True
# Types of C that have no page of their own here.
nitpick_ignore = [("c:identifier", name) for name in ("uint32_t", "uint64_t", "int32_t", "int64_t", "size_t")]
highlight_language = "none"
# A changelog names the same headings for each version.
suppress_warnings = ["myst.header"]

pygments_style = "xcode"
pygments_dark_style = "github-dark"

html_theme = "furo"
html_title = "uncross"
html_static_path = [str(ROOT / "site/site.css"), str(ROOT / "site/site.js")]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_search_scorer = str(ROOT / "site/scorer.js")
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"footer_icons": []}
