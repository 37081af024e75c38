"""What Debian's furo needs to work from any folder: its script and a style sheet are parts that other builds put together; and what axe-core asks for."""
import pathlib
import re

NORMALIZE = pathlib.Path("/usr/share/javascript/normalize.css/normalize.css")


def put_together(app, error):
    if error is not None:
        return
    static = pathlib.Path(app.outdir) / "_static"
    script, part = static / "scripts/furo.js", static / "scripts/gumshoe-patched.js"
    text = script.read_text(encoding="utf-8")
    if part.exists() and text.startswith("import Gumshoe"):
        script.write_text(part.read_text(encoding="utf-8") + text.partition("\n")[2], encoding="utf-8")
        part.unlink()
    sheet = static / "styles/furo.css"
    text = sheet.read_text(encoding="utf-8")
    # The colors of the dark theme, also where the reader's system asks for it: nested conditions got lost in Debian's build.
    dark = re.search(r'@media not print \{\s*body\[data-theme="dark"\] (\{[^}]*\})', text)[1]
    text += f'\n@media screen and (prefers-color-scheme: dark) {{ body:not([data-theme="light"]) {dark} }}\n'
    sheet.write_text(re.sub(r"@import url\(/javascript/normalize\.css/[^)]*\);", lambda _: NORMALIZE.read_text(encoding="utf-8"), text), encoding="utf-8")


def navigation(_app, name, _template, context, _doctree):
    """Headings with a level; and the live page, which Sphinx does not know, before the page about it."""
    tree = context.get("furo_navigation_tree", "").replace('role="heading"', 'role="heading" aria-level="2"')
    running = f'<li class="toctree-l1"><a class="reference external" href="{"../" * name.count("/")}live/index.html">Live page</a></li>\n'
    context["furo_navigation_tree"] = re.sub(r'(?=<li class="[^"]*"><a class="[^"]*" href="[^"]*">About the live page</a>)', lambda _: running, tree)


def setup(app):
    app.connect("build-finished", put_together)
    app.connect("html-page-context", navigation, priority=900)  # after furo's own
    return {"parallel_read_safe": True}
